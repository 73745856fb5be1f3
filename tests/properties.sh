#!/usr/bin/env bash
# properties.sh [COUNT] [FIRST_SEED]: bakes COUNT (1000) scenes by chance in a release build, on all cores, and judges them by
# physics (tests/properties). Prints each fault, its scene with as few things as still fail, and a summary; exits 1 after a fault.
# Such a scene is judged again by `build-release/tests/properties/opaline_properties 'SCENE'`.
set -euo pipefail
cd "$(dirname "$0")/.."
count=${1:-1000} first=${2:-0} each=20
cmake --preset release >/dev/null
cmake --build --preset release --target opaline_properties >/dev/null
faults=$(mktemp)
trap 'rm -f "$faults"' EXIT
export OMP_NUM_THREADS=1
seq "$first" "$each" $((first + count - 1)) |
    xargs -P "$(nproc)" -I{} sh -c \
        'n=$(('"$first + $count"' - {})); build-release/tests/properties/opaline_properties $((n < '"$each"' ? n : '"$each"')) {} || true' \
        2>/dev/null | grep -v '^[0-9]* scenes' | tee "$faults" || true
echo "$count scenes, $(grep -c '^seed' "$faults" || true) with a fault"
! grep -q '^seed' "$faults"
