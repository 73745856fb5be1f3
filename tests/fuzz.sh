#!/usr/bin/env bash
# Builds what libFuzzer runs, gives each reader SECONDS of mutated files, one reader after the other, and keeps what was reached
# for the next time; then says which lines of formats/ were. What it finds is minimised and lies in build-fuzz/found/TARGET:
# once mended, it goes to tests/fuzz/corpus/TARGET, which CI replays. fuzz.sh SECONDS [TARGET...]; clang. Exit code 1: a finding.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -gt 0 ] || { echo "usage: fuzz.sh SECONDS [TARGET...]" >&2; exit 2; }
seconds=$1
shift
cd "$root"
bash .ci/setup.sh
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target opaline_fuzz opaline_fuzz_seeds
build=$root/build-fuzz programs=$root/build-fuzz/tests/fuzz
export LLVM_PROFILE_FILE=/dev/null
# Large blocks are refused, as where memory ends; leaks of libraries that a damaged file makes are not ours to mend.
export ASAN_OPTIONS=allocator_may_return_null=1:detect_leaks=0:handle_abort=1
"$programs/opaline_fuzz_seeds" "$build/seeds"
[ $# -gt 0 ] || set -- $(ls "$build/seeds")
cases=$root/../shared/cases  # files that once failed, where there are any
for pair in glb:gltf json:media exr:exr hdr:hdr vdb:vdb; do
    find "$cases" -name "*.${pair%%:*}" ! -name cases.json -size -20k -exec cp -t "$build/seeds/${pair##*:}" {} + 2>/dev/null || true
done

failed=0
for target; do
    export OPALINE_FUZZ_TARGET=$target
    work=$build/reached/$target found=$build/found/$target corpus=$root/tests/fuzz/corpus/$target
    mkdir -p "$work" "$found" "$corpus"
    echo "== $target =="
    "$programs/opaline_fuzz" -max_total_time="$seconds" -rss_limit_mb=3000 -timeout=20 -max_len=70000 -keep_seed=1 \
        -artifact_prefix="$found/" -print_final_stats=1 "$work" "$build/seeds/$target" "$corpus" >"$build/$target.log" 2>&1 || true
    grep -E '^stat::(number_of_executed_units|peak_rss_mb)|^SUMMARY|^broken promise|at once, where' "$build/$target.log" || true
    # No more files than reach something that no other does.
    rm -rf "$work.merged"
    mkdir "$work.merged"
    "$programs/opaline_fuzz" -merge=1 -max_len=70000 "$work.merged" "$work" "$build/seeds/$target" >/dev/null 2>&1 || true
    rm -rf "$work"
    mv "$work.merged" "$work"
    for input in "$found"/crash-* "$found"/timeout-* "$found"/oom-*; do
        [ -e "$input" ] || continue
        failed=1
        "$programs/opaline_fuzz" -minimize_crash=1 -runs=2000 -exact_artifact_path="$input.smaller" "$input" >/dev/null 2>&1 || true
        echo "finding: $input"
    done
    LLVM_PROFILE_FILE=$build/$target.profraw "$programs/opaline_fuzz" -runs=0 -max_len=70000 "$work" "$corpus" >/dev/null 2>&1 || true
done

if compgen -G "$build/*.profraw" >/dev/null; then
    echo "== lines of formats/ that all of them reach, by folder =="
    llvm-profdata merge -o "$build/reached.profdata" "$build"/*.profraw
    llvm-cov export -summary-only -instr-profile="$build/reached.profdata" "$programs/opaline_fuzz" "$root/formats" |
        python3 -c '
import collections, json, os, sys
root = sys.argv[1] + "/"
lines = collections.defaultdict(lambda: [0, 0])
for file in json.load(sys.stdin)["data"][0]["files"]:
    count = file["summary"]["lines"]
    folder = lines[os.path.dirname(os.path.relpath(file["filename"], root))]
    folder[0] += count["covered"]
    folder[1] += count["count"]
for name, (covered, count) in sorted(lines.items()):
    print(f"{name:<16} {covered:>6} of {count:>6}  {100 * covered / count:.0f} %")' "$root"
fi
exit "$failed"
