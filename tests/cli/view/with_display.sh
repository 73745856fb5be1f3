#!/usr/bin/env bash
# with_display.sh COMMAND...: runs a command on an X display of its own, which has no monitor and draws in software.
# Its exit status is the command's; 77 where there is no Xvfb.
set -euo pipefail
command -v Xvfb >/dev/null || exit 77
folder=$(mktemp -d)
Xvfb -displayfd 3 -screen 0 1400x1000x24 -nolisten tcp 3>"$folder/number" >"$folder/log" 2>&1 &
server=$!
trap 'kill "$server" 2>/dev/null || true; wait "$server" 2>/dev/null || true; rm -rf "$folder"' EXIT
until [ -s "$folder/number" ]; do
    kill -0 "$server" 2>/dev/null || { cat "$folder/log" >&2; exit 77; }
    sleep 0.02
done
DISPLAY=:$(cat "$folder/number") "$@"
