#!/usr/bin/env bash
# Remakes Figures 5 to 8 of [Suykens2001] with this program: pieces of metal and of rough glass on a textured board at 4
# paths a pixel, without a filter, filtered over local footprints, with the limit of the gradient, and with many paths.
# The board glows with its picture, four times each way, under an even sky about as bright, so that in glass and metal
# hardly anything but the texture makes noise. Prints the error in display values, of parts of them where the board
# shows, and seconds; draws OUT_DIR/playing-pieces.png.
# usage: playing_pieces.sh OUT_DIR [OPALINE]     OPALINE: the program, default build/opaline
# Needs the Debian packages imagemagick, fonts-dejavu-core, perl and python3 beside Opaline.
# PLAYING_PIECES_SPP=N in the environment: paths a pixel of the last figure.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: playing_pieces.sh OUT_DIR [OPALINE]" >&2; exit 2; }
mkdir -p "$1/work"
out=$(realpath "$1")
opaline=$(realpath "${2:-$root/build/opaline}")
many=${PLAYING_PIECES_SPP:-256}
cd "$out/work"
for tool in convert montage compare perl python3; do
    command -v "$tool" >/dev/null || { echo "playing_pieces.sh: $tool is missing (see the head of this script)" >&2; exit 4; }
done

"$opaline" example playing-pieces -o . >/dev/null
python3 - <<'PY'
import json, struct
scene = json.load(open("playing-pieces.gltf"))
board = next(m for m in scene["materials"] if m["name"] == "Board")
base = board["pbrMetallicRoughness"]
board["emissiveFactor"] = [1, 1, 1]
board["emissiveTexture"] = base.pop("baseColorTexture")
base["baseColorFactor"] = [0, 0, 0, 1]
board["extensions"] = {"KHR_materials_specular": {"specularFactor": 0}, "KHR_materials_emissive_strength": {"emissiveStrength": 3}}
scene["extensionsUsed"].append("KHR_materials_emissive_strength")
# The picture four times each way.
bytes_ = bytearray(open("playing-pieces.bin", "rb").read())
number = next(i for i, m in enumerate(scene["materials"]) if m is board)
mesh = next(p for m in scene["meshes"] for p in m["primitives"] if p["material"] == number)
accessor = scene["accessors"][mesh["attributes"]["TEXCOORD_0"]]
start = scene["bufferViews"][accessor["bufferView"]].get("byteOffset", 0) + accessor.get("byteOffset", 0)
for i in range(2 * accessor["count"]):
    at = start + 4 * i
    struct.pack_into("<f", bytes_, at, 4 * struct.unpack_from("<f", bytes_, at)[0])
open("glowing.bin", "wb").write(bytes_)
scene["buffers"][0]["uri"] = "glowing.bin"
json.dump(scene, open("glowing.gltf", "w"))
PY

# Of a picture of 288x216: what is drawn larger, and of that where the board shows.
declare -A part=([glass]=88x72+118+88 [brass]=60x96+76+22 [in-glass]=56x22+132+98 [in-brass]=30x22+92+66)
draw() { # NAME SPP FILTER
    "$opaline" reference glowing.gltf --light white --exposure -0.7 --max-depth 4 --size 288x216 --azimuth -20 --elevation 30 \
        --target -0.010,0.018,0.05 --distance 0.15 --fov 30 --spp "$2" --texture-filter "$3" -o "$1.png" 2>"$1.log"
    for name in "${!part[@]}"; do
        convert "$1.png" -crop "${part[$name]}" +repage "$1-$name.png"
    done
}
draw many "$many" none
error() { compare -metric RMSE "$1-$2.png" "many-$2.png" null: 2>&1 | perl -ne '/\(([\d.e-]+)\)/ and printf "%.1f %%", 100 * $1' || true; }
seconds() { perl -ne 'if (/pixels, ([\d.]+) (ms|s|min)/) { printf "%.1f", $1 * ($2 eq "ms" ? 1e-3 : $2 eq "s" ? 1 : 60) }' "$1.log"; }

echo "| figure | error, glass | error, brass | seconds |"
echo "|---|---:|---:|---:|"
panels=()
show() { # NAME LABEL
    convert \( "$1-glass.png" -filter point -resize 300% \) \( "$1-brass.png" -filter point -resize 225% \) +append "$1-parts.png"
    convert "$1.png" -filter point -resize 138.2% \( "$1-parts.png" \) -append -resize 399x\! "$1-panel.png"
    panels+=(-label "$2" "$1-panel.png")
}
row() { # FIGURE NAME FILTER LABEL
    draw "$2" 4 "$3"
    echo "| $1, $4 | $(error "$2" in-glass) | $(error "$2" in-brass) | $(seconds "$2") |"
    show "$2" "Fig. $1: $4, 4 paths a pixel"
}
row 5 none none "no filter"
row 6 local footprint "local footprints"
row 7 limited limited "limited by the gradient"
show many "Fig. 8: $many paths a pixel"
montage -background white -font DejaVu-Sans -pointsize 13 "${panels[@]}" -tile 2x2 -geometry +3+3 -depth 8 \
    -colors 255 "PNG8:$out/playing-pieces.png"
