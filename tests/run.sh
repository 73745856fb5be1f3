#!/usr/bin/env bash
# Installs what is missing, builds everything, runs the tests, and names those that were skipped. Works on a bare
# Debian 12. Arguments go to ctest; without any, all tests run but those labelled "long" or "build" (-R . runs these too).
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

bash .ci/setup.sh
cmake --preset release -DOPALINE_BUILD_TESTS=ON >/dev/null
cmake --build --preset release
results=$root/build-release/test-results.xml
failed=0
left_out=
if [ $# -eq 0 ]; then
    set -- -LE 'long|build'
    left_out='Tests labelled "long" or "build" were left out: bash tests/run.sh -R . runs all.'
fi
# ctest cuts the output of tests that passed; the reason for a skip stands in it.
ctest --preset release -j "$(nproc)" --output-junit "$results" --test-output-size-passed 1000000 "$@" || failed=$?
python3 tests/summarise_results.py "$results" || failed=1
[ -z "$left_out" ] || echo "$left_out"
exit "$failed"
