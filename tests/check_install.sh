#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs into a fresh folder, builds the example against what was installed, through CMake and through pkg-config, and
# runs it. What must not be passed on (the dragon) must not have been installed.
#
# usage: check_install.sh SOURCE-FOLDER BUILD-FOLDER C-COMPILER [FLAGS], FLAGS as the library was compiled with
set -eu
source=$1
build=$2
cc=$3
flags=${4-}

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
prefix=$folder/prefix

fail() {
    echo "$1" >&2
    exit 1
}

# Every line is a surface and its radiance; the upward one, in the sun, is brighter than the one in the shade.
run_example() { # program
    "$1" >"$folder/output" || fail "$1 failed"
    cat "$folder/output"
    awk '!/: [0-9.]+ [0-9.]+ [0-9.]+$/ { bad = 1 }
         NR == 1 { lit = $(NF - 2) }
         NR == 2 { shaded = $(NF - 2) }
         END { exit bad || NR != 4 || lit <= 2 * shaded || shaded <= 0 }' "$folder/output" \
        || fail "$1 printed something else than four lit surfaces"
}

cmake --install "$build" --prefix "$prefix" >"$folder/log" || { cat "$folder/log"; fail 'installing failed'; }
(cd "$prefix" && find . -type f | sort)
[ -z "$(find "$prefix" -iname '*dragon*')" ] || fail 'the dragon was installed'
[ -n "$(find "$prefix/share/heliostat" -name 'LICENSE-*')" ] || fail 'the licence of the environment map is missing'

# Engines include the shaders on devices that have no doubles.
if grep -rnE '\<(double|dvec[234]|dmat[234])\>|[0-9]LF\>' "$prefix/share/heliostat/shaders"; then
    fail 'the installed shaders need doubles'
fi

echo '-- the example through CMake'
cmake -S "$source/examples" -B "$folder/example" -G Ninja -DCMAKE_PREFIX_PATH="$prefix" -DCMAKE_C_COMPILER="$cc" \
    -DCMAKE_C_FLAGS="$flags" >"$folder/log" || { cat "$folder/log"; fail 'configuring the example failed'; }
cmake --build "$folder/example" >"$folder/log" || { cat "$folder/log"; fail 'building the example failed'; }
run_example "$folder/example/estimate"

if [ -x "$folder/example/vulkan_light" ]; then
    echo '-- light on an engine'"'"'s own device'
    status=0
    "$folder/example/vulkan_light" || status=$?
    [ "$status" = 0 ] || [ "$status" = 77 ] || fail 'vulkan_light failed'
fi

echo '-- the example through pkg-config'
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name heliostat.pc)")
export PKG_CONFIG_PATH
# shellcheck disable=SC2046,SC2086 # words on purpose
"$cc" $flags "$source/examples/estimate.c" -o "$folder/estimate" $(pkg-config --cflags --libs heliostat)
LD_LIBRARY_PATH=$(pkg-config --variable=libdir heliostat)
export LD_LIBRARY_PATH
run_example "$folder/estimate"

if [ -x "$prefix/bin/heliostat" ]; then
    echo '-- the installed program'
    "$prefix/bin/heliostat" info

    echo '-- where it has its map'
    unset HELIOSTAT_ASSETS
    map=$prefix/share/heliostat/sunrise.hdr
    [ -f "$map" ] || fail 'the map is missing'
    echo damaged >"$map"
    "$prefix/bin/heliostat" bench --stages cube --quick --quiet 2>"$folder/log" && fail 'it takes the map of the sources'
    grep -q "$(cd "$folder" && pwd -P)/prefix/share/heliostat/sunrise.hdr" "$folder/log" || { cat "$folder/log"; fail 'it takes another map than its own'; }
fi

# What an earlier installation has left must not come before the sources.
echo '-- assets of the sources and installed ones'
mkdir -p "$folder/tree/build" "$folder/tree/assets" "$folder/old"
touch "$folder/tree/assets/map" "$folder/old/map" "$folder/old/only_old"
cat >"$folder/find.c" <<'END'
#include "asset.h"
#include <stdio.h>
int main(int count, char **names)
{
    char path[4096];
    for (int i = 1; i < count; i++)
        puts(asset_find(names[i], path, sizeof path) ? path : "none");
}
END
# shellcheck disable=SC2086 # words on purpose
"$cc" $flags -D_GNU_SOURCE -I"$source/cli" -DHELIOSTAT_ASSET_DIR_RELATIVE='"../share/heliostat"' \
    -DHELIOSTAT_ASSET_DIR_SOURCE="\"$folder/tree/assets\"" -DHELIOSTAT_ASSET_DIR_INSTALL="\"$folder/old\"" \
    "$folder/find.c" "$source/cli/asset.c" -o "$folder/tree/build/find"
[ "$("$folder/tree/build/find" map only_old neither)" = "$(printf '%s\n' "$folder/tree/assets/map" "$folder/old/only_old" none)" ] \
    || fail 'assets are looked for in another order'
