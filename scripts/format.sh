#!/bin/sh
# SPDX-License-Identifier: MIT
# Formats all C files, or with --check tells where they are not formatted and fails.
set -eu
cd "$(dirname "$0")/.."

case ${1-} in
    '') set -- -i ;;
    --check) set -- --dry-run --Werror ;;
    *) echo "usage: $0 [--check]" >&2; exit 2 ;;
esac
find include src cli tests examples fuzz -name '*.[ch]' -exec clang-format "$@" {} +
