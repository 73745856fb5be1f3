#!/usr/bin/env bash
# What a change does to the bytes and errors of bakes: every example at draft, with 1 and 5 threads, against the table
# tests/data/golden_bakes.tsv (example, SHA-256 of its file, stated error, model error; errors relative).
#     tests/golden_bakes.sh [--update] [--hashes] [BUILD-FOLDER] [EXAMPLE...]
# --update writes the table anew, --hashes leaves out the model errors. A table holds for one kind of processor: Embree and
# libm choose instructions by it. No part of CI: half an hour on 2 cores. Exits with 1 where a row differs.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
table=$root/tests/data/golden_bakes.tsv
update= hashes=
while [[ ${1:-} == --* ]]; do
    case $1 in
        --update) update=1 ;;
        --hashes) hashes=1 ;;
        *) sed -n 's/^#     /usage: /p' "$0" >&2; exit 2 ;;
    esac
    shift
done
opaline=$(realpath "${1:-$root/build-release}")/opaline
names=("${@:2}")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
if [ ${#names[@]} -eq 0 ]; then
    mapfile -t names < <("$opaline" example --list | sed -n '/^Lights/q; s/^  \([a-z-]\+\) .*/\1/p')
fi

# errors REPORT: the stated error and the model error of a report, "-" where it has none.
errors() {
    python3 -c '
import json, sys
report = json.load(open(sys.argv[1]))
def text(error): return "%.4g" % error["rms_relative"] if error and "rms_relative" in error else "-"
print(text(report.get("error")), text(report.get("model_error")), sep="\t")' "$1"
}

failed=0
for name in "${names[@]}"; do
    "$opaline" example "$name" -o . --quiet >/dev/null
    scene=$name.gltf
    [ -e "$scene" ] || scene=$name.json
    for threads in 1 5; do
        "$opaline" bake "$scene" -o "$threads.opal" --quality draft --threads $threads --quiet --report "$threads.json"
    done
    cmp -s 1.opal 5.opal || { echo "$name: 1 and 5 threads differ"; failed=1; }
    stated=$(errors 1.json)
    if [ -z "$hashes" ]; then
        "$opaline" bake "$scene" -o checked.opal --quality draft --quiet --check-model --report checked.json
        stated=$(errors checked.json)
    fi
    row="$name	$(sha256sum <1.opal | cut -c1-64)	$stated"
    echo "$row" >>rows.tsv
    before=$(grep "^$name	" "$table" 2>/dev/null || true)
    if [ -n "$hashes" ]; then
        [ "$(cut -f2 <<<"$before")" = "$(cut -f2 <<<"$row")" ] && continue
    else
        [ "$before" = "$row" ] && continue
    fi
    printf '%s\n' "before: ${before:-nothing}" "now:    $row"
    [ -n "$update" ] || failed=1
done
[ -z "$update" ] || { printf 'example\tsha256\tstated\tmodel\n'; cat rows.tsv; } >"$table"
exit "$failed"
