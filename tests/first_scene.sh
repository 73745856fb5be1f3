#!/usr/bin/env bash
# first_scene.sh OPALINE [QUALITY]: the scene that is made first in a modeller, a plane of four vertices with things on it, baked
# with and without receivers that follow the light, and with the even grid of edges that errs as little; each beside path
# tracing under an even sky, a sun of 3 degrees and a studio: relative RMS over the picture. Takes minutes.
set -euo pipefail
opaline=$(realpath "$1")
quality=${2:-preview}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"

# A lat-long map of a disc of 3 degrees over black, white surfaces that face it show 1.
cat >sun.py <<'END'
import math, struct
w, h, azimuth, elevation = 1440, 720, math.radians(30), math.radians(40)
to_sun = (math.sin(azimuth) * math.cos(elevation), math.sin(elevation), -math.cos(azimuth) * math.cos(elevation))
inside, solid = set(), 0.0
for y in range(h):
    theta = math.pi * (y + 0.5) / h
    for x in range(w):
        phi = 2 * math.pi * (x + 0.5) / w
        d = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
        if sum(a * b for a, b in zip(d, to_sun)) > math.cos(math.radians(1.5)):
            inside.add((x, y))
            solid += math.sin(theta) * (math.pi / h) * (2 * math.pi / w)
m, e = math.frexp(math.pi / solid)
lit, dark = bytes([int(m * 256)] * 3 + [e + 128]), bytes(4)
with open("sun.hdr", "wb") as f:
    f.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {h} +X {w}\n".encode())
    for y in range(h):
        f.write(b"".join(lit if (x, y) in inside else dark for x in range(w)))
END
python3 sun.py

view=(--size 480x300 --eye 3.2,2.4,4.2 --target 0,.3,0 --fov 40)
"$opaline" example first-scene -o . >/dev/null 2>&1
for light in white sun.hdr studio; do
    "$opaline" reference first-scene.gltf --light "$light" -o "true-$light.exr" --spp 512 "${view[@]}" 2>/dev/null
done
printf '%-12s %10s %10s %8s %8s %8s %8s\n' refine receivers bytes 'CPU s' white sun studio
for refine in off auto "${@:3}"; do
    seconds=$({ TIMEFORMAT='%U'; time "$opaline" bake first-scene.gltf -o a.opal --quality "$quality" --refine "$refine" 2>/dev/null; } 2>&1)
    receivers=$("$opaline" info a.opal --json | python3 -c 'import json, sys; print(json.load(sys.stdin)["receivers"])')
    printf '%-12s %10s %10s %8.1f' "$refine" "$receivers" "$(stat -c %s a.opal)" "$seconds"
    for light in white sun.hdr studio; do
        "$opaline" render a.opal --light "$light" -o a.exr --backend cpu "${view[@]}" 2>/dev/null
        error=$("$opaline" compare a.exr "true-$light.exr" | awk '/relative rmse/ {print 100 * $NF}')
        printf ' %6.1f %%' "$error"
    done
    printf '\n'
done
