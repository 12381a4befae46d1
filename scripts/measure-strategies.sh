#!/bin/sh
# SPDX-License-Identifier: MIT
# The study of all strategies that docs/performance.md tells of: without and with shadow rays.
#
# usage: measure-strategies.sh BUILD-FOLDER FOLDER-WITH-MAPS OUT [option of heliostat study...]
# What is finished in OUT is not measured again. The tables that it prints last of each study are in Markdown, for
# docs/performance.md to take; they stay in OUT/none/study.md and OUT/ray/study.md.
set -eu
build=${1:?usage: measure-strategies.sh BUILD-FOLDER FOLDER-WITH-MAPS OUT [option...]}
maps=${2:?which folder has the maps?}
out=${3:?which folder should hold the studies?}
shift 3
studies=$(dirname "$0")/../docs
mkdir -p "$out"
# Lists are separated by semicolons here, so that names may hold commas.
list=$(find "$maps" -name '*.hdr' -o -name '*.exr' | sort | paste -sd ';')
for visibility in none ray; do
    echo "== shadow rays: $visibility"
    "$build/heliostat" study --study "$studies/study-strategies.json" --envs "$list" --visibility "$visibility" \
        --out "$out/$visibility" --resume "$@" >"$out/$visibility.txt"
    cat "$out/$visibility.txt" "$out/$visibility/study.md"
done
