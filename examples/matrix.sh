#!/usr/bin/env bash
# The matrix of tests/bench/RESULTS.md: decisions of the planner with their bounds, seconds of the
# planned bake, of a bake with everything forced on, and predicted; the last also at production quality.
# usage, from the top folder: matrix.sh OPALINE MODEL.glb
#   MODEL.glb: a closed body, about 15 cm to 2 m long, with one material
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: matrix.sh OPALINE MODEL.glb" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" example knot -o "$work" >/dev/null
"$1" example statue -o "$work" >/dev/null
python3 - "$1" "$2" "$work" <<'PY'
import json, math, struct, subprocess, sys
opaline, model, work = sys.argv[1:]

def write_mesh(path, points, normals, triangles):
    """A glTF with one grey, single-sided primitive."""
    data = b"".join(struct.pack("<3f", *p) for p in points + normals)
    data += b"".join(struct.pack("<3I", *t) for t in triangles)
    n, m = len(points), 3 * len(triangles)
    low = [min(p[k] for p in points) for k in range(3)]
    high = [max(p[k] for p in points) for k in range(3)]
    json.dump({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0, "name": "Body"}],
        "materials": [{"name": "Body"}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2,
                                    "material": 0}]}],
        "buffers": [{"uri": path.split("/")[-1] + ".bin", "byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * n},
                        {"buffer": 0, "byteOffset": 12 * n, "byteLength": 12 * n},
                        {"buffer": 0, "byteOffset": 24 * n, "byteLength": 4 * m}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3", "min": low, "max": high},
            {"bufferView": 1, "componentType": 5126, "count": n, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5125, "count": m, "type": "SCALAR"}]},
        open(path, "w"))
    open(path + ".bin", "wb").write(data)

def ball(path, rings):
    """A sphere of radius 10 cm: rings of latitude, twice as many vertices along each."""
    points, triangles, columns = [], [], 2 * rings
    for i in range(1, rings):
        for j in range(columns):
            t, p = math.pi * i / rings, 2 * math.pi * j / columns
            points.append((math.sin(t) * math.cos(p), math.cos(t), -math.sin(t) * math.sin(p)))
    north, south = len(points), len(points) + 1
    points += [(0, 1, 0), (0, -1, 0)]
    at = lambda i, j: (i - 1) * columns + j % columns
    for j in range(columns):
        triangles += [(north, at(1, j), at(1, j + 1)), (south, at(rings - 1, j + 1), at(rings - 1, j))]
        for i in range(1, rings - 1):
            triangles += [(at(i, j), at(i + 1, j), at(i + 1, j + 1)),
                          (at(i, j), at(i + 1, j + 1), at(i, j + 1))]
    write_mesh(path, [tuple(0.1 * x for x in p) for p in points], points, triangles)

def leaf(path, cells):
    """Two sides of a sheet, 10 cm wide, 0.3 mm thick, open at its rim."""
    points, normals, triangles = [], [], []
    for side in (1, -1):
        first = len(points)
        for i in range(cells + 1):
            for j in range(cells + 1):
                points.append((0.1 * i / cells, side * 1.5e-4, 0.1 * j / cells))
                normals.append((0, side, 0))
        for i in range(cells):
            for j in range(cells):
                a, b = first + i * (cells + 1) + j, first + (i + 1) * (cells + 1) + j
                t = [(a, a + 1, b), (b, a + 1, b + 1)]
                triangles += t if side > 0 else [(x, z, y) for x, y, z in t]
    write_mesh(path, points, normals, triangles)

def medium(**keys):
    path = work + "/" + str(abs(hash(str(keys)))) + ".json"
    json.dump({"materials": {"*": keys}}, open(path, "w"))
    return ["--media", path]

ball(work + "/ball.gltf", 96)
leaf(work + "/leaf.gltf", 48)
soft = dict(sigma_s=[20, 18, 15], sigma_a=[.05, .1, .2], unit="1/m", eta=1.4)
scenes = [
    ("ball, opaque", work + "/ball.gltf", []),
    ("knot, opaque, on its floor", work + "/knot.gltf", []),
    ("ball, clay, mean free path 4 um", work + "/ball.gltf",
     medium(sigma_s=[200, 150, 100], sigma_a=[40, 80, 150], unit="1/mm", eta=1.3)),
    ("statue, marble, and its opaque floor", work + "/statue.gltf",
     ["--media", "examples/media/marble.json"]),
    ("leaf, two open sides", work + "/leaf.gltf",
     medium(sigma_s=[2, 4, 1], sigma_a=[2, .5, 4], unit="1/mm", eta=1.4)),
    ("model, wax", model, medium(**soft)),
    ("model, wax, g = .5", model, medium(**soft, phase={"type": "hg", "g": .5})),
    ("model, ketchup", model, medium(preset="ketchup")),
    ("model, whole milk", model, medium(preset="whole-milk")),
    ("ball, ink", work + "/ball.gltf",
     medium(sigma_s=[.001, .001, .001], sigma_a=[1, 1, 1], unit="1/mm", eta=1.33)),
]

def bake(scene, options, quality, effects="auto"):
    report = work + "/report.json"
    subprocess.run([opaline, "bake", scene, *options, "--quality", quality, "--effects", effects,
                    "--progress", "none", "-o", work + "/baked.opal", "--report", report],
                   check=True, stderr=subprocess.DEVNULL)
    return json.load(open(report))

names = ["direct", "multiple", "single", "specular", "light.visibility", "multiple.spread",
         "single.terms", "light.colour"]
times = ["planned", "predicted", "all", "ratio", "production", "predicted"]
print("| scene | " + " | ".join([name.split(".")[-1] for name in names] + times) + " |")
print("|---|" + "---|" * len(names) + "---:|" * len(times))
for name, scene, options in scenes:
    planned, everything = (bake(scene, options, "preview", e) for e in ("auto", "all"))
    production = bake(scene, options, "production")
    cells = []
    for effect in names:
        rows = [e for e in planned["plan"] if e["effect"] == effect and
                (e["bound"] > 0 or e["decision"] == "on" or effect == "light.colour")]
        mark = lambda e: ("**on** " if e["decision"] == "on" else "off ") + "%.2g" % e["bound"]
        cells.append(", ".join(mark(e) for e in rows) or "-")
    seconds = lambda r: "%.1f s | %.1f s" % (r["seconds_total"], r["predicted_seconds_total"])
    a, b = planned["seconds_total"], everything["seconds_total"]
    print("| %s | %s | %s | %.1f s | %.1f | %s |" %
          (name, " | ".join(cells), seconds(planned), b, b / a, seconds(production)), flush=True)
PY
