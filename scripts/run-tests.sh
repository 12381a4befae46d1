#!/bin/sh
# SPDX-License-Identifier: MIT
# Runs ctest in this folder with the given options. Where tests fail, what they said of it comes again at the end, as it
# is far up in what was printed.
#
# usage: run-tests.sh [CTEST-OPTION...]
set -u

ctest "$@"
code=$?
if [ $code -ne 0 ] && [ -f Testing/Temporary/LastTest.log ]; then
    echo
    echo 'What failed said:'
    grep -aE '\[  (FAILED|ERROR)|\[   LINE|: error: |^[^ ]+: .* in place of |exit code -?[0-9]+|ERROR: .*Sanitizer|runtime error|Timeout' \
        Testing/Temporary/LastTest.log | cut -c 1-400 | tail -n 60
fi
exit $code
