#!/usr/bin/env bash
# faults.sh OPALINE: what the program does where something happens to it from outside: killed, stopped, no disk, no memory, no
# one who reads, inputs that change. Exit codes, no stack traces, no damaged or left-over files. A few minutes. What needs a
# right to mount, or to be another user, is skipped aloud without it. deep.sh runs it; quick cases stand in tests/cli.
set -uo pipefail
[ $# -eq 1 ] && [ -x "$1" ] || { echo "usage: faults.sh OPALINE" >&2; exit 2; }
opaline=$(realpath "$1")
folder=$(mktemp -d)
trap 'umount "$folder/disk" 2>/dev/null; rm -rf "$folder"' EXIT
cd "$folder"
export XDG_CACHE_HOME=$folder/cache
failed=0 checks=0

fail() { echo "FAILED: $*"; failed=1; }
# check WHAT COMMAND...: a command that must succeed.
check() {
    local what=$1
    shift
    checks=$((checks + 1))
    "$@" || fail "$what"
}
# has_code WHAT CODE ACCEPTED...: an exit code; errors that are a fault of the program are none.
has_code() {
    local what=$1 code=$2 accepted
    shift 2
    checks=$((checks + 1))
    grep -qE 'terminate called|please report|Sanitizer|Assertion|core dumped' err 2>/dev/null && fail "$what: $(cat err)"
    for accepted; do [ "$code" -eq "$accepted" ] && return; done
    fail "$what: exit code $code, not $*: $(tail -c 300 err 2>/dev/null)"
}
# sound FILE: it is not there, or it is whole.
sound() { [ ! -e "$1" ] || "$opaline" --quiet verify "$1" >/dev/null; }
no_leftover() { [ -z "$(find "${1:-.}" -maxdepth 1 -name '.opaline-*')" ]; }

"$opaline" --quiet example bricks >/dev/null
"$opaline" --quiet example first-scene >/dev/null
scene=bricks/bricks.gltf
long="bake $scene -o out.opal --quality preview --threads 2"
begin=$(date +%s%N)
"$opaline" --quiet bake first-scene/first-scene.gltf --quality draft -o small.opal 2>err || fail "a bake: $(cat err)"
milliseconds=$((($(date +%s%N) - begin) / 1000000))
cp small.opal former.opal

echo "== killed at 20 moments of a bake =="
for i in $(seq 20); do
    cp former.opal out.opal
    "$opaline" --quiet bake first-scene/first-scene.gltf --quality draft -o out.opal 2>err &
    sleep "$(awk -v i="$i" -v t="$milliseconds" 'BEGIN { print i / 20 * t / 1000 }')"
    kill -9 $! 2>/dev/null
    wait $! 2>/dev/null
    check "killed: the former file or a whole one" sound out.opal
    check "killed: a file is there" test -s out.opal
done
"$opaline" --quiet bake first-scene/first-scene.gltf --quality draft -o out.opal 2>err
has_code "a bake after those that were killed" $? 0
check "the same bytes as undisturbed" cmp -s out.opal small.opal
check "nothing is left over" no_leftover

echo "== signals =="
run_and_signal() {  # SIGNAL SECONDS ARGUMENTS...
    local signal=$1 seconds=$2 process
    shift 2
    "$opaline" "$@" >out 2>err &
    process=$!
    sleep "$seconds"
    kill -s "$signal" "$process" 2>/dev/null
    wait "$process"
}
rm -f out.opal
for signal in TERM HUP; do  # SIGINT is ignored by what a shell starts in the background; tests/cli sends it
    # shellcheck disable=SC2086
    run_and_signal "$signal" 1 $long
    has_code "SIG$signal in a bake" $? 130
    check "SIG$signal: no output" test ! -e out.opal
    run_and_signal "$signal" 1 reference first-scene/first-scene.gltf --light studio -o r.exr --spp 4096
    has_code "SIG$signal in a reference" $? 130
    run_and_signal "$signal" 1 render small.opal --backend cpu --frames 500 -o frame.png
    has_code "SIG$signal in a film" $? 130 129 143  # before its first frame there is nothing to lose
    for picture in $(compgen -G 'frame-*.png'); do
        check "frames are whole" test "$(tail -c 8 "$picture" | head -c 4)" = IEND
    done
    rm -f frame-*.png
done
check "nothing is left over" no_leftover

echo "== no one reads =="
for command in "info small.opal" "info --json small.opal" "plan $scene" "verify small.opal" "--help" "example --list" \
    "phase --type hg --g 0.9" "relight small.opal --light studio -o a.csv" "render small.opal --backend cpu --stats -o a.png" \
    "export-gltf small.opal -o a.glb" "bake first-scene/first-scene.gltf --quality draft --progress json -o b.opal"; do
    # shellcheck disable=SC2086
    "$opaline" $command 2>err | head -n 1 >/dev/null
    has_code "$command | head" "${PIPESTATUS[0]}" 0 141
    # shellcheck disable=SC2086
    (trap '' PIPE; "$opaline" $command 2>err; echo $? >code) | true
    has_code "$command, its pipe broken" "$(cat code)" 0 4
    for closed in '>&-' '2>&-' '>&- 2>&-' '<&- >&- 2>&-'; do
        eval "\"\$opaline\" $command $closed" >out 2>err
        has_code "$command $closed" $? 0 4
    done
    # shellcheck disable=SC2086
    "$opaline" $command >/dev/full 2>err
    has_code "$command >/dev/full" $? 0 4
done
check "a bake whose messages nobody reads" cmp -s b.opal small.opal
check "a file that was written all the same" test -s a.glb

env -u DISPLAY -u WAYLAND_DISPLAY "$opaline" view small.opal >&- 2>err
has_code "view without a display" $? 4

echo "== memory =="
"$opaline" bake $scene -o m.opal --memory-limit 1000000 2>err
has_code "a limit of memory" $? 4
check "it says so" grep -q 'raise --memory-limit' err
for megabytes in 220 400 700; do  # with less, OpenVDB ends the program before main
    for command in "bake first-scene/first-scene.gltf --quality draft -o m.opal" "relight small.opal --light studio -o m.csv" \
        "render small.opal --backend cpu -o m.png" "export-gltf small.opal -o m.glb" "info small.opal"; do
        # shellcheck disable=SC2086
        (ulimit -v $((megabytes * 1000)); exec timeout -s KILL 120 "$opaline" $command) >out 2>err
        has_code "$command in $megabytes MB" $? 0 4
    done
done
check "a bake in little memory is whole or not there" sound m.opal
check "nothing is left over" no_leftover

echo "== two bakes to one file =="
rm -f two.opal
"$opaline" --quiet bake first-scene/first-scene.gltf --quality draft -o two.opal 2>err &
"$opaline" --quiet bake first-scene/first-scene.gltf --quality draft -o two.opal 2>err2
has_code "the second bake" $? 0
wait $!
has_code "the first bake" $? 0
check "the file is one of them" cmp -s two.opal small.opal

echo "== inputs that change during a bake =="
hash_of() { "$opaline" info --json "$1" | grep -o '"[a-z_]*sha256": *"[0-9a-f]*"' | sort | tr -d '\n'; }
cp -r first-scene changed
"$opaline" --quiet bake changed/first-scene.gltf --quality draft -o changed.opal 2>err &
sleep "$(awk -v t="$milliseconds" 'BEGIN { print t / 2000 }')"
sed -i 's/"roughnessFactor": *[0-9.]*/"roughnessFactor": 0.77/' changed/first-scene.gltf
wait $!
has_code "a bake whose scene changes" $? 0
"$opaline" --quiet bake changed/first-scene.gltf --quality draft -o after.opal 2>err
check "the file states the scene that it was baked of" test "$(hash_of changed.opal)" = "$(hash_of small.opal)"
check "which is not the one there now" test "$(hash_of changed.opal)" != "$(hash_of after.opal)"
check "a hash is stated" test -n "$(hash_of changed.opal)"
for i in 1 2 3 4 5 6; do  # and while it is read
    "$opaline" --quiet bake changed/first-scene.gltf --quality draft -o changed.opal 2>err &
    sleep "0.0$i"
    truncate -s 1000 changed/first-scene.bin
    wait $!
    has_code "a bake whose buffer is cut" $? 0 3
    cp first-scene/first-scene.bin changed/
    check "its file is whole" sound changed.opal
done

echo "== folders that cannot be written to =="
if [ "$(id -u)" -eq 0 ]; then
    mkdir -m 755 locked open
    chmod 755 "$folder"
    as_nobody="setpriv --reuid 65534 --regid 65534 --clear-groups"
else
    mkdir locked open && chmod 555 locked
    as_nobody=
fi
if $as_nobody test -x "$opaline" 2>/dev/null; then
    for command in "bake first-scene/first-scene.gltf --quality draft -o locked/a.opal" "relight small.opal --light studio -o locked/a.csv" \
        "render small.opal --backend cpu -o locked/a.png" "export-gltf small.opal -o locked/a.glb" \
        "export-web small.opal -o locked/page" "example knot -o locked/knot"; do
        $as_nobody env XDG_CACHE_HOME=/nonexistent "$opaline" $command >out 2>err
        has_code "$command by someone else" $? 4
        check "$command says why" grep -q 'Permission denied' err
    done
    check "nothing is there" test -z "$(ls -A locked)"
else
    echo "SKIPPED: $opaline cannot be run by another user"
fi

echo "== disks of all sizes that are too small =="
mkdir disk
if mount -t tmpfs -o size=4k none disk 2>/dev/null; then
    umount disk
    cp small.opal in.opal
    size=$(stat -c %s small.opal)
    for share in 0 5 20 50 80 95 99; do
        bytes=$((size * share / 100 / 4096 * 4096 + 4096))
        mount -t tmpfs -o size=$bytes none disk
        for command in "bake first-scene/first-scene.gltf --quality draft -o disk/a.opal --report disk/r.json --depfile disk/d" \
            "relight small.opal --light studio -o disk/a.csv" "relight small.opal --light studio -o disk/a.ply" \
            "render small.opal --backend cpu -o disk/a.exr" "render small.opal --backend cpu -o disk/a.png" \
            "export-gltf small.opal -o disk/a.glb" "export-web small.opal -o disk/page"; do
            # shellcheck disable=SC2086
            "$opaline" $command >out 2>err
            code=$?
            has_code "$command on $bytes bytes" $code 0 4
            if [ $code -ne 0 ]; then
                check "$command on $bytes bytes says why" grep -q 'No space left' err
                check "$command on $bytes bytes leaves nothing: $(ls -A disk)" test -z "$(ls -A disk)"
            fi
            rm -rf disk/* disk/.[!.]*
        done
        # shellcheck disable=SC2024
        "$opaline" info --json small.opal >disk/info 2>err
        has_code "info on $bytes bytes" $? 0 4
        umount disk
    done
else
    echo "SKIPPED: no right to mount a small disk here"
fi

echo "$checks checks"
exit "$failed"
