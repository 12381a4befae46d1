#!/bin/sh
# SPDX-License-Identifier: MIT
# Static analysis of what a build folder compiles: clang-tidy with the checks of .clang-tidy, then cppcheck.
#
# usage: lint.sh BUILD-FOLDER [FOLDER...]
# clang-tidy looks at the named folders of sources; without, at src and cli. It takes some seconds for each file.
set -eu
cd "$(dirname "$0")/.."
build=${1:?usage: lint.sh BUILD-FOLDER [FOLDER...]}
shift
[ $# -gt 0 ] || set -- src cli
jobs=$(nproc)

# clang does not know all options of the compiler that built it.
mkdir -p "$build/lint"
sed 's/ -fno-loop-unroll-and-jam//g; s/ -fno-tree-loop-distribute-patterns//g' "$build/compile_commands.json" \
    >"$build/lint/compile_commands.json"

# One process for each file, as several files in one confuse the check of va_list. The file that defines fail() cannot
# have analyzer.h. What clang-tidy prints is shown only where it finds something: it counts warnings of system headers.
tidy() {
    find "$@" -name '*.c' ! -path src/core/error.c -print0 | xargs -0 -n 1 -P "$jobs" \
        clang-tidy -p "$build/lint" --quiet --extra-arg=-include --extra-arg="$PWD/scripts/analyzer.h" 2>&1
}
echo 'clang-tidy'
output=$(tidy "$@") || { echo "$output" | grep -Ev ' generated\.$'; exit 1; }

echo 'cppcheck'
# Headers of the system are not read, which is what makes it quick.
cppcheck --quiet --error-exitcode=1 --std=c11 --enable=warning,performance,portability --inline-suppr \
    --suppress=missingIncludeSystem -j "$jobs" -I include -I src \
    -D HELIO_WITH_OPENEXR=1 -D HELIO_WITH_PNG=1 -D HELIO_WITH_JPEG=1 -D HELIO_WITH_ASSIMP=1 -D HELIO_WITH_EMBREE=1 \
    -D HELIO_WITH_FFMPEG=1 -D HELIO_WITH_LCMS2=1 -D HELIO_WITH_CAIRO=1 \
    -D HELIO_EMBREE_MAJOR=3 -D _GNU_SOURCE src cli
