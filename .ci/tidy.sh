#!/usr/bin/env bash
# tidy.sh [BASE]: clang-tidy on the sources that changed since the commit BASE. By default that is where the branch
# left origin/main or, on main itself, 20 commits ago. At most 10 files, those with most changed lines first.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cd "$root"
most_files=10
build=build-tidy
seconds_per_file=300

base=${1:-$(git merge-base HEAD origin/main 2>/dev/null || true)}
if [ -z "$base" ] || [ "$base" = "$(git rev-parse HEAD)" ]; then
    base=$(git rev-list --max-count=21 HEAD | tail -n 1)
fi

# The commands of the preset "asan", one for each source.
cmake --preset asan -B "$build" -DCMAKE_UNITY_BUILD=OFF -DOPALINE_BUILD_TESTS=OFF >/dev/null

# "added removed path" -> paths, most changed first. Files that are gone, or that nothing builds, are left out.
changed=()
while read -r path; do
    grep -qF "\"$root/$path\"" "$build/compile_commands.json" && changed+=("$path")
done < <(git diff --numstat --no-renames --diff-filter=d "$base" HEAD -- 'bake/*.cpp' 'formats/*.cpp' 'runtime/*.cpp' |
    awk '{ print $1 + $2, $3 }' | sort -rn | cut -d' ' -f2)

chosen=("${changed[@]:0:$most_files}")
echo "clang-tidy: ${#chosen[@]} of ${#changed[@]} sources changed since ${base:0:10}: ${chosen[*]}"
[ ${#chosen[@]} -eq 0 ] && exit 0
printf '%s\0' "${chosen[@]}" |
    xargs -0 -n 1 -P "$(nproc)" timeout "$seconds_per_file" clang-tidy --quiet -p "$build"
