#!/usr/bin/env bash
# Figure 4 of [Suykens2001] remade: a room by particles, with the elements that their footprints join.
# Writes examples/images/elements.png.
# The tool is a bench: cmake --preset bench && cmake --build --preset bench --target opaline_bench
# usage: elements.sh OPALINE_BENCH [PARTICLES]
set -euo pipefail
[ $# -eq 1 ] || [ $# -eq 2 ] || { echo "usage: elements.sh OPALINE_BENCH [PARTICLES]" >&2; exit 2; }
images=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)/images
"$1" radiosity-figure "$images/elements.png" "${2:-400000}"
