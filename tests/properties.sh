#!/usr/bin/env bash
# properties.sh [COUNT] [FIRST_SEED]: bakes COUNT (1000) scenes by chance in a release build, on all cores, and judges them by
# physics (tests/properties). Prints each fault, its scene with as few things as still fail, and a summary; exits 1 after a fault.
# Such a scene is judged again by `build-release/tests/properties/opaline_properties 'SCENE'`.
# properties.sh coverage [COUNT] [FIRST_SEED]: of how many (of 100) the stated error covers what path tracing finds.
set -euo pipefail
cd "$(dirname "$0")/.."
mode=judge each=20
if [ "${1:-}" = coverage ]; then
    mode=coverage each=4
    shift
    set -- "${1:-100}" "${2:-0}"
fi
count=${1:-1000} first=${2:-0}
cmake --preset release >/dev/null
cmake --build --preset release --target opaline_properties >/dev/null
lines=$(mktemp)
trap 'rm -f "$lines"' EXIT
export OMP_NUM_THREADS=1
seq "$first" "$each" $((first + count - 1)) |
    xargs -P "$(nproc)" -I{} sh -c \
        'n=$(('"$first + $count"' - {})); build-release/tests/properties/opaline_properties '"${mode#judge}"' $((n < '"$each"' ? n : '"$each"')) {} || true' \
        2>/dev/null | grep -v '^[0-9]* scenes' | tee "$lines" || true
if [ "$mode" = coverage ]; then
    echo "covered: $(grep -c '^covered' "$lines" || true) of $(grep -c 'seed' "$lines" || true)"
    exit
fi
echo "$count scenes, $(grep -c '^seed' "$lines" || true) with a fault"
! grep -q '^seed' "$lines"
