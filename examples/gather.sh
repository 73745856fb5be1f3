#!/usr/bin/env bash
# What the tolerance of the gather and the number of coefficients cost: the statue in jade, multiple
# scattering alone, against the sum over all samples. Prints a table for the README.
# usage: gather.sh OPALINE
set -euo pipefail
[ $# -eq 1 ] || { echo "usage: gather.sh OPALINE" >&2; exit 2; }
opaline=$(realpath "$1")
media=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/media/jade.json
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
"$opaline" example statue -o . >/dev/null

echo "| ε | M | rows | file | white | studio | sky:3,35 | suns |"
echo "|---:|---:|---:|---:|---:|---:|---:|---:|"
for setting in "0 128" "1e-4 128" "1e-3 64" "1e-3 128" "1e-3 256" "1e-3 512" "1e-2 128"; do
    read -r epsilon m <<<"$setting"
    "$opaline" bake statue.gltf --media "$media" --effects multiple --samples 20000 \
        --epsilon "$epsilon" --coefficients "$m" --cubemap 32 -o s.opal --report s.json 2>/dev/null
    python3 - "$epsilon" "$m" <<'PY'
import json, math, sys
r = json.load(open("s.json"))
light = r["error"]["by_light"]
suns = [v for k, v in light.items() if k.startswith("sun")]
seconds = sum(s["seconds"] for s in r["stages"] if s["name"].startswith("rows") and "Statue" in s["name"])
print("| %s | %s | %.1f s | %.1f MB | %.2f %% | %.2f %% | %.1f %% | %.1f %% |" % (
    sys.argv[1], sys.argv[2], seconds, r["output"]["bytes"] / 1e6, 100 * light["white"],
    100 * light["studio"], 100 * light["sky:3,35"],
    100 * math.sqrt(sum(v * v for v in suns) / len(suns))))
PY
done
