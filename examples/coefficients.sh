#!/usr/bin/env bash
# Error and size for M coefficients: bakes an example with M = 16 ... all and prints a Markdown table
# of file sizes and relit errors against the file with all coefficients (tests/bench/RESULTS.md).
# usage: coefficients.sh OPALINE [SCENE...]     OPALINE: the program; SCENE: statue, knot
set -euo pipefail
opaline=$(realpath "$1")
shift
scenes=("$@")
[ ${#scenes[@]} -gt 0 ] || scenes=(statue knot)
lights=(white studio sky:3,35 sun:40,30)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

relative_rmse() { "$opaline" compare "$1" "$2" | awk '/relative rmse/ { printf "%.2f %%", 100 * $3 }'; }

for scene in "${scenes[@]}"; do
    "$opaline" example "$scene" -o "$folder" >/dev/null
    echo "| $scene: M | file | bytes a vertex | ${lights[*]/#/error, } |" | sed 's/ error,/ | error,/2g'
    echo "|---:|---:|---:|---:|---:|---:|---:|"
    for m in all 1024 512 256 128 64 32 16; do
        "$opaline" bake "$folder/$scene.gltf" -o "$folder/$m.opal" --cubemap 32 --coefficients "$m" --report "$folder/report.json" 2>/dev/null
        bytes=$(stat -c %s "$folder/$m.opal")
        receivers=$(awk -F'[:,]' '/"receivers":/ { print $2 + 0 }' "$folder/report.json")
        row="| $m | $(awk "BEGIN { printf \"%.1f MB\", $bytes / 1e6 }") | $((bytes / receivers)) |"
        for light in "${lights[@]}"; do
            "$opaline" relight "$folder/$m.opal" --light "$light" -o "$folder/$m.csv"
            [ "$m" != all ] || cp "$folder/all.csv" "$folder/reference-${light%%:*}.csv"
            row+=" $(relative_rmse "$folder/$m.csv" "$folder/reference-${light%%:*}.csv") |"
        done
        echo "$row"
    done
    echo
done
