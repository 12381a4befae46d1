#!/bin/sh
# SPDX-License-Identifier: MIT
# Switches off one feature at a time; what is left must build without warnings and pass its tests.
#
# usage: check_features.sh SOURCE-FOLDER C-COMPILER
set -eu
source=$1
cc=$2

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

for feature in OPENEXR PNG JPEG ASSIMP EMBREE FFMPEG LCMS2 CAIRO VULKAN; do
    echo "-- without $feature"
    build=$folder/$feature
    cmake -S "$source" -B "$build" -G Ninja -DCMAKE_C_COMPILER="$cc" -DHELIO_WERROR=ON -DBUILD_TESTING=ON \
        "-DHELIO_WITH_$feature=OFF" "-DHELIO_TEST_DATA=${HELIO_TEST_DATA-}"
    cmake --build "$build"
    ctest --test-dir "$build" --parallel "$(nproc)" --output-on-failure --label-exclude long
    rm -rf "$build"
done
