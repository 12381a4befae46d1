#!/bin/sh
# SPDX-License-Identifier: MIT
# Installs the Debian and Ubuntu packages that are missing, and says which and why; silent where nothing is missing.
#
# usage: install-dependencies.sh build|test|ci
#   build: for `make` and `make demo`; test: and for `make test`; ci: and for `make lint` and `make check-format`
set -eu

case ${1-} in
    build) wanted='build' ;;
    test) wanted='build test' ;;
    ci) wanted='build test ci' ;;
    *) echo "usage: $0 build|test|ci" >&2; exit 2 ;;
esac

# set, package, command that makes it unnecessary (or -), what it is for
table='build cmake cmake building
build ninja-build ninja building
build gcc gcc compiling
build libc6-dev - compiling
build pkgconf pkg-config finding libraries
build libembree-dev - tracing rays
build libassimp-dev - reading meshes
build libopenexr-dev - OpenEXR pictures
build libpng-dev - PNG pictures
build libjpeg-dev - JPEG pictures
build zlib1g-dev - gzipped meshes
build libavformat-dev - video files
build libavcodec-dev - video
build libavdevice-dev - cameras and test patterns
build libjansson-dev - statistics in JSON
build libcairo2-dev - figures
build liblcms2-dev - differences of colours
build libvulkan-dev - graphics processors
build glslc glslc shaders
test spirv-tools spirv-val shaders
test mesa-vulkan-drivers - a graphics processor in software
test vulkan-validationlayers - the use of graphics processors
test libcmocka-dev - tests
test g++ g++ testing the headers in C++
ci clang clang a second compiler
ci libclang-rt-dev - sanitizers and libFuzzer for clang
ci clang-format clang-format code style
ci clang-tidy clang-tidy static analysis
ci cppcheck cppcheck static analysis'

candidates=$(echo "$table" | while read -r set package command reason; do
    case " $wanted " in *" $set "*) ;; *) continue ;; esac
    if [ "$command" = - ] || ! command -v "$command" >/dev/null; then
        echo "$package $reason"
    fi
done)

describe() { # lines of package and reason
    echo "$1" | sed 's/\([^ ]*\) \(.*\)/\1 (\2)/' | paste -sd , | sed 's/,/, /g'
}

if ! command -v dpkg-query >/dev/null; then
    echo "This system has no dpkg, so nothing is installed. By their Debian names, these are needed:" >&2
    echo "  $(describe "$candidates")" >&2
    exit 0
fi

# dpkg-query fails as soon as one of the packages is unknown to it: exactly what is asked here.
names=$(echo "$candidates" | cut -d ' ' -f 1)
# shellcheck disable=SC2086 # one word per package
installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' $names 2>/dev/null || true)
missing=$(echo "$candidates" | while read -r package reason; do
    echo "$installed" | grep -qxF "installed $package" || echo "$package $reason"
done)
if [ -z "$missing" ]; then
    exit 0
fi

packages=$(echo "$missing" | cut -d ' ' -f 1 | paste -sd ' ')
echo "Packages that are missing: $(describe "$missing")"
if [ "$(id -u)" -eq 0 ]; then
    as_root=
elif command -v sudo >/dev/null && sudo -n true 2>/dev/null; then
    as_root='sudo -n'
else
    echo "Installing them takes root, or sudo without a password. Please run this, then try again:" >&2
    echo "  sudo apt-get install --no-install-recommends $packages" >&2
    exit 1
fi

# shellcheck disable=SC2086 # words on purpose
if ! { $as_root apt-get update -qq && $as_root env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -qq -o Dpkg::Use-Pty=0 --no-install-recommends $packages; }; then
    echo "Installing failed; the lines above tell why." >&2
    exit 1
fi
