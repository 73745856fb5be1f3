#!/usr/bin/env bash
# From a bare Debian 12 to two pictures: installs what is missing, builds Opaline, makes the statue,
# bakes it, and renders it under two lights.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build="$root/build-quickstart"
out="$root/out"

bash "$root/.ci/setup.sh"
cmake -S "$root" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DOPALINE_BUILD_TESTS=OFF >/dev/null
cmake --build "$build" --target opaline
opaline="$build/opaline"

mkdir -p "$out"
"$opaline" example statue -o "$out"
# Four times the default coefficients: a hard sun needs them, soft light does not.
"$opaline" bake "$out/statue.gltf" -o "$out/statue.opal" --coefficients 512
"$opaline" render "$out/statue.opal" --light studio --size 1280x960 -o "$out/statue-studio.png"
"$opaline" render "$out/statue.opal" --light sky:3,35 --size 1280x960 -o "$out/statue-sky.png"

echo
echo "The pictures are:"
echo "  $out/statue-studio.png"
echo "  $out/statue-sky.png"
