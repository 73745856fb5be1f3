#!/usr/bin/env bash
# The page of a sweep in a headless browser: every chart is drawn, nothing is asked of the network,
# the console stays silent. Usage: report_page.sh OPALINE BROWSER
set -euo pipefail
opaline=$1 browser=$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export HOME=$folder  # a browser writes there

"$opaline" example knot -o "$folder" >/dev/null
"$opaline" sweep "$folder/knot.gltf" -o "$folder/sweep" --seconds 5 2>"$folder/messages"
open_page() {
    timeout 60 "$browser" --headless --no-sandbox --disable-gpu --disable-background-networking \
        --disable-quic --no-first-run --disable-component-update --disable-sync \
        --user-data-dir="$folder/profile-$1" --enable-logging=stderr --v=0 \
        --virtual-time-budget=5000 "--window-size=$1,6000" "${@:3}" "file://$2"
}
# After the page's own script: charts that exist, and pictures that were decoded.
probe='<script>addEventListener("load", () => { document.title = "drawn " +
  [...document.querySelectorAll("canvas")].filter(c => Chart.getChart(c)).length + " of " +
  document.querySelectorAll("canvas").length + " charts, " +
  [...document.images].filter(i => i.naturalWidth === 0).length + " broken pictures, " +
  (document.documentElement.scrollWidth > innerWidth ? "too wide" : "fits") + ", " +
  performance.getEntriesByType("resource").filter(e => !e.name.startsWith("data:")).length +
  " requests"; });</script>'
{ cat "$folder/sweep/report.html"; printf '%s\n' "$probe"; } >"$folder/page.html"

for width in 1200 700; do
    open_page $width "$folder/page.html" --dump-dom >"$folder/dom" 2>"$folder/console"
    if grep -E 'CONSOLE' "$folder/console"; then
        echo "the console is not silent at $width pixels" >&2
        exit 1
    fi
    title=$(grep -o '<title>[^<]*</title>' "$folder/dom")
    echo "$width pixels: $title"
    [[ $title =~ drawn\ ([0-9]+)\ of\ ([0-9]+)\ charts,\ 0\ broken\ pictures,\ fits,\ 0\ requests ]]
    [ "${BASH_REMATCH[1]}" -ge 4 ]
    [ "${BASH_REMATCH[1]}" -eq "${BASH_REMATCH[2]}" ]
done
