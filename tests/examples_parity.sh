#!/usr/bin/env bash
# Every example, baked at draft quality, in all back ends: hosts' functions in OpenGL 4.5, 4.3 and ES 3.1 against the
# CPU's (opaline_gl_parity), then pictures of `opaline render` by OpenGL against the CPU's, under two lights.
#     tests/examples_parity.sh FOLDER [BUILD-FOLDER]
# Bakes that FOLDER has already are kept; pictures are left there for a look. Some ten minutes on 2 cores. The build
# needs OPALINE_BUILD_BENCH. Exits with 1 where something is beyond its tolerance. Pages: tests/bench/web_pages.py.
set -euo pipefail
[ $# -ge 1 ] || { echo "usage: examples_parity.sh FOLDER [BUILD-FOLDER]" >&2; exit 2; }
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
build=$(realpath "${2:-$root/build-release}")
opaline=$build/opaline
parity=$build/tests/bench/gl_parity/opaline_gl_parity
mkdir -p "$1"
cd "$1"

mapfile -t names < <("$opaline" example --list | sed -n '/^Lights/q; s/^  \([a-z-]\+\) .*/\1/p')
for name in "${names[@]}"; do
    [ -s "$name.opal" ] && continue
    "$opaline" example "$name" -o scenes --quiet >/dev/null
    scene=scenes/$name.gltf
    [ -e "$scene" ] || scene=scenes/$name.json
    "$opaline" bake "$scene" -o "$name.opal" --quality draft --quiet
done

failed=0
"$parity" "${names[@]/%/.opal}" || failed=1

echo
for name in "${names[@]}"; do
    for light in sky:3,35 studio; do
        for backend in cpu gl; do
            for kind in exr png; do
                "$opaline" render "$name.opal" --light "$light" --size 128x96 --backend "$backend" --quiet \
                    -o "$name-${light%%:*}-$backend.$kind" >/dev/null
            done
        done
        echo -n "$name, $light: "
        "$parity" --pictures "$name-${light%%:*}-cpu.exr" "$name-${light%%:*}-gl.exr" || failed=1
    done
done
exit "$failed"
