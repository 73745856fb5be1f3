#!/usr/bin/env bash
# The whole suite under the address and undefined-behaviour sanitizers, then the tests that use several
# threads under the thread sanitizer; ends with a summary. Hours on 2 cores: no part of what every change
# must pass. Arguments go to both ctest runs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"

# run_suite PRESET CTEST-ARGUMENTS...: builds and tests; leaves build-PRESET/test-results.xml.
run_suite() {
    local preset=$1
    shift
    cmake --preset "$preset" >/dev/null &&
        cmake --build --preset "$preset" &&
        ctest --preset "$preset" -j "$(nproc)" --timeout 7200 --no-tests=error \
            --output-junit "$root/build-$preset/test-results.xml" --test-output-size-passed 1000000 "$@"
}

bash .ci/setup.sh
failed=0
# Compiling every header by itself finds nothing more under a sanitizer.
run_suite asan -LE build "$@" || failed=1
# Programs whose cases run together, in one process, count by the program's name.
run_suite tsan -R 'Thread|example_test|reference_test' "$@" || failed=1

for preset in asan tsan; do
    echo "== $preset =="
    python3 tests/summarise_results.py "build-$preset/test-results.xml" || failed=1
done
exit "$failed"
