#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs fuzz targets for some time each, and tells in one line what came of it. Fails if one of them finds something, and
# says where the input lies.
#
# usage: fuzz.sh BUILD-FOLDER SECONDS [TARGET...]
# The corpus of fuzz/corpus is copied to BUILD-FOLDER/fuzz/run/TARGET and grows there from run to run.
set -eu
cd "$(dirname "$0")/.."
usage='usage: fuzz.sh BUILD-FOLDER SECONDS [TARGET...]'
build=${1:?$usage}
seconds=${2:?$usage}
shift 2

if [ $# -eq 0 ]; then
    for program in "$build"/fuzz/fuzz_*; do
        set -- "$@" "${program##*/fuzz_}"
    done
fi

# Inputs need no more bytes than this to reach everything; the largest files of the corpus may have more.
run() { # target
    work=$build/fuzz/run/$1
    mkdir -p "$work/corpus" "$work/found"
    cp "fuzz/corpus/$1"/* "$work/corpus"
    set -- "$1" "$work/corpus" -max_total_time="$seconds" -max_len=4096 -timeout=20 -rss_limit_mb=1024 \
        -malloc_limit_mb=128 -artifact_prefix="$work/found/" -print_final_stats=1
    if [ -f "fuzz/dictionaries/$1.dict" ]; then
        set -- "$@" -dict="fuzz/dictionaries/$1.dict"
    fi
    target=$1
    shift
    "$build/fuzz/fuzz_$target" "$@" >"$work/log" 2>&1
}

failed=0
for target in "$@"; do
    if [ ! -x "$build/fuzz/fuzz_$target" ]; then
        names=$(basename -a "$build"/fuzz/fuzz_* | sed 's/fuzz_//' | paste -sd ' ')
        echo "there is no target $target; there are: $names" >&2
        exit 2
    fi
    if run "$target"; then
        inputs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$work/log")
        edges=$(sed -n 's/^.* cov: \([0-9]*\) .*/\1/p' "$work/log" | tail -n 1)
        printf '%-14s found nothing: %s inputs in %s s, %s edges covered\n' "$target" "$inputs" "$seconds" "$edges"
    else
        failed=1
        file=$(sed -n 's/.*Test unit written to //p' "$work/log" | tail -n 1)
        printf '%-14s FOUND %s\n' "$target" "$(grep -m 1 -E 'ERROR|runtime error|does not hold' "$work/log" || echo something)"
        echo "    the input: ${file:-none was written}"
        echo "    the report: $work/log; again: $build/fuzz/fuzz_$target ${file:-}"
    fi
done
exit $failed
