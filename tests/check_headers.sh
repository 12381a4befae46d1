#!/bin/sh
# SPDX-License-Identifier: MIT
# Each public header must compile alone, as C11 and as C++17, so that the order of includes never matters.
#
# usage: check_headers.sh SOURCE-FOLDER C-COMPILER C++-COMPILER
set -eu
source=$1
cc=$2
cxx=$3

check() { # compiler, language, standard, header
    echo "$4 as $3"
    echo "#include <heliostat/$4>" | "$1" -x "$2" -std="$3" -I "$source/include" -fsyntax-only \
        -Wall -Wextra -Wpedantic -Wshadow -Werror -
}

count=0
for path in "$source"/include/heliostat/*.h; do
    header=$(basename "$path")
    if [ "$header" = vulkan.h ] && ! echo '#include <vulkan/vulkan.h>' | "$cc" -x c -fsyntax-only - 2>/dev/null; then
        echo "$header is skipped: there is no <vulkan/vulkan.h>"
        continue
    fi
    check "$cc" c c11 "$header"
    check "$cxx" c++ c++17 "$header"
    count=$((count + 1))
done
if [ "$count" -lt 6 ]; then
    echo "only $count headers were found in $source/include/heliostat" >&2
    exit 1
fi
