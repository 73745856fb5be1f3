#!/usr/bin/env bash
# Files of `opaline export-gltf` in other programs: Khronos' validator finds no error and no warning, and three.js and
# Babylon.js, in a headless Chromium, show each as `opaline render --tone-map none` does from the same camera.
#     tests/gltf_viewers.sh [BUILD-FOLDER] [FOLDER]
# FOLDER, by default a temporary one, keeps bakes and pictures for a look. Needs node, npm (which fetches the packages
# named below) and Chromium: without them it is skipped, exit code 77. Exits with 1 where a picture is beyond its bound.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
opaline=$(realpath "${1:-$root/build-release}")/opaline
work=${2:-}
if [ -z "$work" ]; then
    work=$(mktemp -d)
    trap 'rm -rf "$work"' EXIT
fi
mkdir -p "$work"
cd "$work"
browser=$(command -v chromium || true)
skip() { echo "SKIPPED: gltf_viewers: $1" >&2; exit 77; }
command -v npm >/dev/null || skip "npm is not installed"
[ -n "$browser" ] || skip "Chromium is not installed"
npm install --prefix "$work" --no-audit --no-fund --loglevel=error gltf-validator@2.0.0-dev.3.10 three@0.187.0 \
    babylonjs@9.28.0 babylonjs-loaders@9.28.0 playwright-core@1.65.1 >npm.log 2>&1 || skip "npm cannot fetch the packages: $(tail -1 npm.log)"
cp "$root/tests/gltf_viewers.mjs" .

# scene, light, eye, target, most RMS difference of codes / 255: mirrors are interpolated between vertices in a glTF file
cases=(
    "first-scene studio 1.6,1,2.6 0,0.2,0 0.02"
    "first-scene sun:40,30 1.6,1,2.6 0,0.2,0 0.02"
    "knot sky:3,35 0.4,0.35,0.6 0,0.1,0 0.01"
    "playing-pieces sky:3,35 0.2,0.25,0.35 0,0,0 0.035"
    "leaves studio 0.15,0.25,0.2 0,0.05,0 0.015"
)
failed=0
for case in "${cases[@]}"; do
    read -r name light eye target bound <<<"$case"
    if [ ! -s "$name.opal" ]; then
        "$opaline" example "$name" -o scenes --quiet >/dev/null
        "$opaline" bake "scenes/$name.gltf" -o "$name.opal" --quality draft --quiet
    fi
    stem=$name-${light//[:,]/_}
    "$opaline" export-gltf "$name.opal" --light "$light" --eye "$eye" --exposure -1 -o "$stem.glb" --quiet
    "$opaline" render "$name.opal" --light "$light" --eye "$eye" --target "$target" --exposure -1 --tone-map none \
        --size 480x360 --fov 32 -o "$stem.png" --quiet
    BROWSER=$browser node gltf_viewers.mjs "$stem" "$eye" "$target" "$bound" || failed=1
done
exit "$failed"
