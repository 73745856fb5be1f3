#!/usr/bin/env bash
# What CI leaves out: benchmarks and every header compiled by itself; all tests of the g++ release build; the whole suite
# under the address and undefined-behaviour sanitizers; what uses several threads under the thread sanitizer; glTF files in
# other programs, where there is npm; fast tests with floating-point traps. Ends with a summary. Hours on 2 cores. Parts can be
# named: deep.sh [release] [viewers] [traps] [asan] [tsan] [fuzz]; viewers needs the build of release; fuzz, some five hours, is
# left out unless it is named.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
parts=("$@")
[ $# -gt 0 ] || parts=(release viewers traps asan tsan)

# run_suite PRESET CTEST-ARGUMENTS...: builds and tests; leaves build-PRESET/test-results.xml.
run_suite() {
    local preset=$1
    shift
    cmake --preset "$preset" -DOPALINE_BUILD_BENCH=ON >/dev/null &&
        cmake --build --preset "$preset" &&
        ctest --preset "$preset" -j "$(nproc)" --timeout 7200 --no-tests=error \
            --output-junit "$root/build-$preset/test-results.xml" --test-output-size-passed 1000000 "$@"
}

# Fast tests, where 0/0, division by zero and overflow in our code are failures (tests/support/float_traps.cpp).
run_traps() {
    cmake --preset traps >/dev/null && cmake --build --preset traps --target fast_tests &&
        ctest --preset traps -j "$(nproc)" --timeout 7200 --no-tests=error -LE 'slow|long|build|source' -E '^Abi' \
            --output-junit "$root/build-traps/test-results.xml" --test-output-size-passed 1000000
}

# Whole bakes with several threads, the loops of all stages, and the runtime called from many threads.
run_threads() {
    cmake --preset tsan >/dev/null && cmake --build --preset tsan --target base_test pipeline_test runtime_test runtime_picture_test reference_test &&
        TSAN_OPTIONS="suppressions=$root/tests/thread_sanitizer.supp ignore_noninstrumented_modules=1 halt_on_error=1" \
            bash -euc 'for program in "$@"; do "build-tsan/tests/$program" --gtest_filter="*Thread*:Loops.*:ReferenceFurnace.*"; done' \
            _ bake/base/base_test pipeline/pipeline_test runtime/runtime_test runtime/picture/runtime_picture_test bake/reference/reference_test
}

bash .ci/setup.sh
failed=0
for part in "${parts[@]}"; do
    case $part in
        release)
            run_suite release || failed=1
            bash tests/faults.sh build-release/opaline || failed=1
            ;;
        fuzz) bash tests/fuzz.sh 1200 || failed=1 ;;  # 20 minutes a target
        viewers) bash tests/gltf_viewers.sh build-release || [ $? -eq 77 ] || failed=1 ;;
        traps) run_traps || failed=1 ;;
        asan) run_suite asan -LE build || failed=1 ;;  # compiling headers by themselves finds nothing more there
        tsan) run_threads || failed=1 ;;
        *) echo "usage: deep.sh [release] [viewers] [traps] [asan] [tsan] [fuzz]" >&2; exit 2 ;;
    esac
done
for part in "${parts[@]}"; do
    [ -e "build-$part/test-results.xml" ] || continue
    echo "== $part =="
    python3 tests/summarise_results.py "build-$part/test-results.xml" || failed=1
done
exit "$failed"
