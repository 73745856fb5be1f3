#!/usr/bin/env bash
# A row of the table of whole bakes in tests/bench/RESULTS.md: seconds of each stage, size, relights a second.
# Settings of [Wang2005], Table 1: 6 x 32 x 32 directions, 128 coefficients.
# usage: table.sh OPALINE OPALINE_BENCH FILE.gltf MEDIA.json SAMPLES
set -euo pipefail
[ $# -eq 5 ] || { echo "usage: table.sh OPALINE OPALINE_BENCH FILE.gltf MEDIA.json SAMPLES" >&2; exit 2; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
"$1" bake "$3" --media "$4" --samples "$5" --cubemap 32 --coefficients 128 --epsilon 2e-3 \
    -o "$work/baked.opal" --report "$work/report.json" 2>/dev/null
OPALINE_BENCH_ASSET="$work/baked.opal" "$2" speed --benchmark_filter=^on_ --benchmark_out="$work/bench.json" \
    --benchmark_out_format=json >/dev/null 2>&1
python3 - "$work" "$3" "$5" <<'PY'
import json, os, sys
work, name, samples = sys.argv[1:]
report = json.load(open(work + "/report.json"))
rate = {b["name"].split("/")[0] + b["name"].split("/")[1]: b.get("relights/s", 0)
        for b in json.load(open(work + "/bench.json"))["benchmarks"]}
def seconds(start):
    return sum(s["seconds"] for s in report["stages"] if s["name"].startswith(start))
total = report["seconds_total"]
parts = [seconds("samples"), seconds("light maps") + seconds("rows")]
light = report["error"]["by_light"]
print("| %s | %d k | %d k | %s | %.0f s | **%.0f s** | %.1f MB | %.0f | %.0f | %.2f %% | %.2f %% |" % (
    os.path.basename(name), report["output"]["receivers"] / 1000, int(samples) / 1000,
    " | ".join("%.0f s" % p for p in parts), total - sum(parts), total,
    report["output"]["bytes"] / 1e6, rate["on_cpu0"], rate["on_glmanual_time"],
    100 * light["white"], 100 * light["studio"]))
PY
