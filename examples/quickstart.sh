#!/usr/bin/env bash
# From a bare Debian 12 to two pictures: installs what is missing, builds Opaline, makes a statue, bakes
# it in jade, and renders it against the light: a studio's, and a low sun's.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
out="$root/out"

bash "$root/.ci/setup.sh"
cd "$root"
cmake --preset release -DOPALINE_BUILD_TESTS=OFF >/dev/null
cmake --build --preset release --target opaline
opaline="$root/build-release/opaline"

mkdir -p "$out"
"$opaline" example statue -o "$out"
"$opaline" bake "$out/statue.gltf" --media "$root/examples/media/jade.json" -o "$out/jade.opal"
"$opaline" render "$out/jade.opal" --light studio --rotate-light 210 --size 1280x960 -o "$out/jade-studio.png"
"$opaline" render "$out/jade.opal" --light sky:3,25 --rotate-light 240 --size 1280x960 -o "$out/jade-sun.png"

echo
echo "The pictures are:"
echo "  $out/jade-studio.png"
echo "  $out/jade-sun.png"
