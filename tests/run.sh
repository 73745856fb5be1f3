#!/usr/bin/env bash
# Installs what is missing, builds everything, runs the tests, and names those that were skipped. Works on a bare
# Debian 12. Arguments go to ctest; without any, all tests run but those labelled "long" (-R . runs these too).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

bash .ci/setup.sh
cmake --preset release
cmake --build --preset release
results=$root/build-release/test-results.xml
failed=0
[ $# -gt 0 ] || set -- -LE '^long$'
# ctest cuts the output of tests that passed; the reason for a skip stands in it.
ctest --preset release -j "$(nproc)" --output-junit "$results" --test-output-size-passed 1000000 "$@" || failed=$?
python3 tests/summarise_results.py "$results" || failed=1
exit "$failed"
