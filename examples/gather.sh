#!/usr/bin/env bash
# Time and error for the gather's tolerance and the number of coefficients: the statue in jade,
# multiple scattering alone, against the sum over all samples with 1024 coefficients. Figures are in
# tests/bench/RESULTS.md.
# usage: gather.sh OPALINE
set -euo pipefail
[ $# -eq 1 ] || { echo "usage: gather.sh OPALINE" >&2; exit 2; }
opaline=$(realpath "$1")
media=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/media/jade.json
lights=(white studio sky:3,35 sun:30,60 sun:150,35 sun:270,15)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$opaline" example statue -o . >/dev/null

bake() {
    "$opaline" bake statue.gltf --media "$media" --effects multiple --samples 20000 --epsilon "$1" \
        --coefficients "$2" --cubemap 32 -o s.opal --report s.json 2>/dev/null
}
relight() { "$opaline" relight s.opal --light "$1" -o "$2" 2>/dev/null; }
relative_rmse() { "$opaline" compare "$1" "$2" | awk '/relative rmse/ { printf "%.2f %%", 100 * $3 }'; }

bake 0 1024
for light in "${lights[@]}"; do relight "$light" "all-$light.csv"; done
echo "| ε | M | rows | file | ${lights[*]/%/ |}"
echo "|---:|---:|---:|---:|---:|---:|---:|---:|---:|---:|"
for setting in "0 128" "1e-4 128" "1e-3 64" "1e-3 128" "1e-3 256" "1e-3 512" "1e-2 128"; do
    read -r epsilon m <<<"$setting"
    bake "$epsilon" "$m"
    row=$(python3 - "$epsilon" "$m" <<'PY'
import json, sys
r = json.load(open("s.json"))
seconds = sum(s["seconds"] for s in r["stages"] if s["name"].startswith("rows") and "Statue" in s["name"])
print("| %s | %s | %.1f s | %.1f MB |" % (sys.argv[1], sys.argv[2], seconds, r["output"]["bytes"] / 1e6))
PY
    )
    for light in "${lights[@]}"; do
        relight "$light" one.csv
        row+=" $(relative_rmse one.csv "all-$light.csv") |"
    done
    echo "$row"
done
