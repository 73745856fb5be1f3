#!/usr/bin/env bash
# tidy.sh [BASE]: clang-tidy on the lines that changed since the commit BASE. By default that is where the branch left
# origin/main or, on main itself, 20 commits ago. At most 12 sources, those with most changed lines first.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
most_files=12
build=build-tidy
seconds_per_file=300

base=${1:-$(git merge-base HEAD origin/main 2>/dev/null || true)}
if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
    base=$(git rev-list --first-parent --max-count=21 HEAD | tail -n 1)
fi

# The commands of the preset "asan", one for each source, without precompiled headers.
cmake --preset asan -B "$build" -DOPALINE_FAST_BUILD=OFF -DOPALINE_BUILD_TESTS=OFF >/dev/null

# "added removed path" -> paths, most changed first. Files that are gone, or that nothing builds, are left out.
changed=()
while read -r path; do
    grep -qF "\"$root/$path\"" "$build/compile_commands.json" && changed+=("$path")
done < <(git diff --numstat --find-renames --diff-filter=d "$base" HEAD -- 'bake/*.cpp' 'formats/*.cpp' 'runtime/*.cpp' |
    sed -E 's/\{[^}]* => ([^}]*)\}/\1/; s/\t[^\t]* => /\t/; s#//#/#' | # of a file that moved, its name now
    awk '{ print $1 + $2, $3 }' | sort -rn | cut -d' ' -f2)
chosen=("${changed[@]:0:$most_files}")
echo "clang-tidy: lines changed since ${base:0:10} in ${#chosen[@]} of ${#changed[@]} sources: ${chosen[*]}"
[ ${#chosen[@]} -eq 0 ] && exit 0

# The changed lines of these sources and of all headers, as clang-tidy wants them: [{"name":"...","lines":[[first,last],...]}].
filter=$(git diff -U0 --no-color --diff-filter=d "$base" HEAD -- "${chosen[@]}" '*.h' | python3 -c '
import json, re, sys
lines = {}
for line in sys.stdin:
    if line.startswith("+++ b/"):
        name = line[6:].strip()
    elif hunk := re.match(r"@@ -\S+ \+(\d+)(?:,(\d+))? @@", line):
        first, count = int(hunk[1]), int(hunk[2] or 1)
        if count:
            lines.setdefault(name, []).append([first, first + count - 1])
print(json.dumps([{"name": name, "lines": ranges} for name, ranges in lines.items()]))')
printf '%s\0' "${chosen[@]}" |
    xargs -0 -n 1 -P "$(nproc)" timeout "$seconds_per_file" clang-tidy --quiet -p "$build" --line-filter="$filter"
