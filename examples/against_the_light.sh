#!/usr/bin/env bash
# Thin and folded bodies against the light, each as baked and as path tracing has it: a leaf, a fold like the rim of an
# ear, the jade statue, without light from surface to surface. Draws OUT_DIR/against-the-light.png: above the files, below
# the truth.
# usage: against_the_light.sh OUT_DIR [OPALINE]     OPALINE: the program, default build/opaline
# Needs the Debian packages imagemagick and python3 beside Opaline. In the environment: QUALITY of the bakes, default
# preview; SPP, paths a pixel of the truth, default 256. Two minutes on two cores.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: against_the_light.sh OUT_DIR [OPALINE]" >&2; exit 2; }
mkdir -p "$1/work"
out=$(realpath "$1")
opaline=$(realpath "${2:-$root/build/opaline}")
cd "$out/work"
for tool in montage python3; do
    command -v "$tool" >/dev/null || { echo "against_the_light.sh: $tool is missing (see the head of this script)" >&2; exit 4; }
done

"$opaline" example statue -o . >/dev/null
python3 - <<'PY'
import json, math, struct

# A closed disc, bent: place(x, y) of its middle, x and y within the unit disc, and how thick it is there [m].
def write(name, place, thickness, rings=40, spokes=96):
    def middle(r, a):
        return place(r * math.cos(a), r * math.sin(a))
    def normal(r, a):
        x, y, e = r * math.cos(a), r * math.sin(a), 1e-3
        u = [q - p for p, q in zip(place(x - e, y), place(x + e, y))]
        v = [q - p for p, q in zip(place(x, y - e), place(x, y + e))]
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        size = math.sqrt(sum(c * c for c in n))
        return [c / size for c in n]
    points, normals, triangles = [], [], []
    def vertex(r, a, side, turned):
        n, half = normal(r, a), 0.5 * thickness(r * math.cos(a), r * math.sin(a))
        points.append([p + side * half * c for p, c in zip(middle(r, a), n)])
        if turned:  # the rim faces away from the middle
            away = [q - p for p, q in zip(middle(r - 1e-3, a), middle(r, a))]
            size = math.sqrt(sum(c * c for c in away))
            n, side = [c / size for c in away], 1
        normals.append([side * c for c in n])
        return len(points) - 1
    angles = [2 * math.pi * k / spokes for k in range(spokes)]
    for side in (1, -1):
        last = [vertex(0, 0, side, False)] * spokes
        for ring in range(1, rings + 1):
            own = [vertex(math.sin(0.5 * math.pi * ring / rings), a, side, False) for a in angles]
            for k in range(spokes):
                m = (k + 1) % spokes
                for t in ([own[k], own[m], last[k]], [own[m], last[m], last[k]]):
                    if len(set(t)) == 3:
                        triangles.append(t if side > 0 else t[::-1])
            last = own
    upper, lower = ([vertex(1, a, side, True) for a in angles] for side in (1, -1))
    for k in range(spokes):
        m = (k + 1) % spokes
        triangles.extend(([upper[k], lower[k], lower[m]], [upper[k], lower[m], upper[m]]))
    data = b"".join(struct.pack("<3f", *v) for v in points + normals)
    data += b"".join(struct.pack("<3I", *t) for t in triangles)
    open(name + ".bin", "wb").write(data)
    many, low = len(points), [min(p[i] for p in points) for i in range(3)]
    high = [max(p[i] for p in points) for i in range(3)]
    view = lambda first, size: {"buffer": 0, "byteOffset": first, "byteLength": size}
    json.dump({"asset": {"version": "2.0"}, "scenes": [{"nodes": [0]}], "scene": 0, "nodes": [{"mesh": 0}],
               "materials": [{"name": "Body"}], "buffers": [{"uri": name + ".bin", "byteLength": len(data)}],
               "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
               "bufferViews": [view(0, 12 * many), view(12 * many, 12 * many), view(24 * many, 12 * len(triangles))],
               "accessors": [{"bufferView": 0, "componentType": 5126, "count": many, "type": "VEC3", "min": low, "max": high},
                             {"bufferView": 1, "componentType": 5126, "count": many, "type": "VEC3"},
                             {"bufferView": 2, "componentType": 5125, "count": 3 * len(triangles), "type": "SCALAR"}]},
              open(name + ".gltf", "w"))

# A leaf 60 mm long: its halves rise from the rib, which is three times as thick.
write("leaf", lambda x, y: [0.03 * x, 0.017 * y * (1 - 0.35 * x), 0.005 * math.sqrt(y * y + 0.02) - 0.006 * x * x],
      lambda x, y: 0.0005 + 0.0009 * math.exp(-(y / 0.06) ** 2))
# A sheet of 2.5 mm whose upper rim rolls in.
def fold(x, y):
    turn = lambda s: 0.5 * s + 2.2 / (1 + math.exp(-7 * (s - 0.45)))
    steps, length = 60, y + 1
    z = h = 0.0
    for i in range(steps):
        a = turn(-1 + length * (i + 0.5) / steps)
        h, z = h + 0.02 * length / steps * math.cos(a), z + 0.02 * length / steps * math.sin(a)
    return [0.022 * x, h - 0.02, z + 0.006 * x * x]
write("fold", fold, lambda x, y: 0.0025 - 0.0009 * (x * x + y * y))

def medium(name, scattered, absorbed, eta):
    json.dump({"materials": {"Body": {"sigma_s_prime": scattered, "sigma_a": absorbed, "unit": "1/mm", "eta": eta}}},
              open(name + ".json", "w"))
medium("leaf", [2.2, 2.4, 2.0], [0.5, 0.12, 0.9], 1.4)
medium("fold", [0.9, 1.1, 1.3], [0.02, 0.12, 0.2], 1.4)
PY

# name, scene, media, view
picture() {
    local name=$1 scene=$2 media=$3 terms=multiple,single,specular
    shift 3
    local view=(--light studio --rotate-light 180 --size 240x240 --terms "$terms" "$@")
    "$opaline" bake "$scene" --media "$media" --effects "$terms" --quality "${QUALITY:-preview}" -o "$name.opal"
    "$opaline" render "$name.opal" "${view[@]}" --backend cpu -o "$name-file.png"
    "$opaline" reference "$scene" --media "$media" "${view[@]}" --spp "${SPP:-256}" -o "$name-truth.png"
}
picture leaf leaf.gltf leaf.json --azimuth 20 --elevation 20
picture fold fold.gltf fold.json --azimuth 25 --elevation 10
picture jade statue.gltf "$root/examples/media/jade.json" --elevation 8 --distance 0.35
montage leaf-file.png fold-file.png jade-file.png leaf-truth.png fold-truth.png jade-truth.png \
    -tile 3x2 -geometry +2+2 "$out/against-the-light.png"
echo "$out/against-the-light.png"
