#!/usr/bin/env bash
# The page of a sweep in a headless browser, wide and narrow: every chart that has data is drawn, nothing is asked
# of the network, the console stays silent. Usage: report_page.sh REPORT.html BROWSER FOLDER
# FOLDER: to write into.
set -euo pipefail
report=$1 browser=$2 folder=$3
export HOME=$folder  # a browser writes there

# After the page's own script: charts that exist, pictures that were decoded, what was fetched.
probe='<script>addEventListener("load", () => {
  const canvases = [...document.querySelectorAll("canvas")].filter(c => !c.closest("[hidden]"));
  const drawn = canvases.filter(c => Chart.getChart(c) && c.width > 0).length;
  const broken = [...document.images].filter(i => i.naturalWidth === 0).length;
  const fetched = performance.getEntriesByType("resource").filter(e => !e.name.startsWith("data:")).length;
  const wide = document.documentElement.scrollWidth > document.documentElement.clientWidth;
  document.title = `${drawn} of ${canvases.length} charts, ${broken} broken pictures, ` +
    `${fetched} requests, ${wide ? "too wide" : "fits"}`; });</script>'
{ cat "$report"; printf '%s\n' "$probe"; } >"$folder/page.html"

for width in 1200 700; do
    timeout 60 "$browser" --headless --no-sandbox --disable-gpu --disable-background-networking \
        --disable-quic --no-first-run --disable-component-update --disable-sync \
        --user-data-dir="$folder/profile-$width" --enable-logging=stderr --v=0 \
        --virtual-time-budget=5000 "--window-size=$width,6000" --dump-dom "file://$folder/page.html" \
        >"$folder/dom" 2>"$folder/console"
    if grep CONSOLE "$folder/console" >&2; then
        echo "the console is not silent at $width pixels" >&2
        exit 1
    fi
    title=$(grep -o '<title>[^<]*</title>' "$folder/dom" | head -1)
    echo "$width pixels: $title"
    [[ $title =~ ([0-9]+)\ of\ ([0-9]+)\ charts,\ 0\ broken\ pictures,\ 0\ requests,\ fits ]]
    [ "${BASH_REMATCH[1]}" -ge 4 ]
    [ "${BASH_REMATCH[1]}" -eq "${BASH_REMATCH[2]}" ]
done
