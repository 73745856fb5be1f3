#!/usr/bin/env bash
# Remakes Figures 4, 5 and 6 of [Premoze2003] with this program: a block of skim milk, a cloud of noise
# with a Gaussian phase function, a cloud under skylight. Each by path integration, by path integration
# with the paper's formulas as printed (fidelity "paper"), and by Monte Carlo until it has the error of
# the former; prints a table of errors and seconds.
# usage: volumes.sh OUT_DIR [OPALINE]     OPALINE: the program, default build/opaline
# Needs the Debian packages imagemagick, fonts-dejavu-core and perl beside Opaline.
# VOLUMES_SIZE=WxH and VOLUMES_SPP=N in the environment set the size of pictures and the paths per pixel
# of the long Monte Carlo run that both are compared with.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: volumes.sh OUT_DIR [OPALINE]" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
opaline=$(realpath "${2:-$root/build/opaline}")
size=${VOLUMES_SIZE:-256x192}
spp=${VOLUMES_SPP:-256}
mkdir -p "$out/work"
cd "$out/work"
for tool in convert montage perl; do
    command -v "$tool" >/dev/null || { echo "volumes.sh: $tool is missing (see the head of this script)" >&2; exit 4; }
done

# NAME KIND ARGUMENTS...: NAME-KIND.exr of scattered light; its log has seconds and standard error.
scattered() {
    "$opaline" reference "$1.json" "${@:3}" --size "$size" --terms volume-single,volume-multiple \
        -o "$1-$2.exr" 2>"$1-$2.log"
}
# FILE EXPRESSION: the number that the regular expression captures in a log, in seconds if a time.
number() {
    perl -0ne "/$2/ or die qq($1: no match\n); my (\$x, \$u) = (\$1, \$2 // 's');
        print \$x * (\$u eq 'ms' ? 1e-3 : \$u =~ /^min/ ? 60 : 1)" "$1"
}
seconds='pixels, ([\d.]+) (ms|s|min)'
relative_error() { "$opaline" compare "$1" "$2" --json | perl -0ne '/"relative_rmse": *([\d.e+-]+)/ and print $1'; }

# NOISE RMS: RMS without the noise of the long run.
without_noise() { perl -e 'printf "%.4g", sqrt(abs($ARGV[1]**2 - ($ARGV[0] / 100)**2))' "$1" "$2"; }

echo "| figure | paths, RMS error | paths, s | as printed, RMS error | s | Monte Carlo to the error of paths: spp | s | ratio |"
echo "|---|---:|---:|---:|---:|---:|---:|---:|"
# FIGURE NAME LABEL ARGUMENTS...: a row of the table, and OUT_DIR/volumesFIGURE.png.
figure() {
    local n=$1 name=$2 label=$3
    shift 3
    [ -f "$name.json" ] || "$opaline" example "$name" -o . >/dev/null
    perl -pe 's/"file":/"fidelity": "paper", "file":/' "$name.json" >"$name-printed.json"
    scattered "$name" paths "$@" --method path-integration
    scattered "$name-printed" paths "$@" --method path-integration
    scattered "$name" long "$@" --spp "$spp"
    local noise rms error printed equal
    noise=$(number "$name-long.log" 'standard error ([\d.e+-]+) %')
    rms=$(relative_error "$name-paths.exr" "$name-long.exr")
    # Noise of the long run is no error of the paths. One path's error over that of the paths,
    # squared, is how many Monte Carlo needs.
    error=$(without_noise "$noise" "$rms")
    printed=$(without_noise "$noise" "$(relative_error "$name-printed-paths.exr" "$name-long.exr")")
    equal=$(perl -e 'my ($error, $noise, $spp) = @ARGV;
        my $n = $spp * ($noise / 100 / $error)**2; printf "%d", $n < 1 ? 1 : $n + 0.5' \
        "$error" "$noise" "$spp")
    scattered "$name" equal "$@" --spp "$equal" --seed 1
    perl -e 'printf "| %s, %s | %.0f %% | %.2f | %.0f %% | %.2f | %d | %.2f | %.1f |\n", $ARGV[0],
        $ARGV[1], 100 * $ARGV[2], $ARGV[3], 100 * $ARGV[4], $ARGV[5], $ARGV[6], $ARGV[7],
        $ARGV[7] / $ARGV[3]' "$n" "$label" "$error" "$(number "$name-paths.log" "$seconds")" \
        "$printed" "$(number "$name-printed-paths.log" "$seconds")" "$equal" \
        "$(number "$name-equal.log" "$seconds")"
    local shots=(--size "$size")
    "$opaline" reference "$name.json" "$@" "${shots[@]}" --spp "$spp" -o "$name-mc.png" 2>/dev/null
    "$opaline" reference "$name.json" "$@" "${shots[@]}" --spp "$equal" -o "$name-same.png" 2>/dev/null
    "$opaline" reference "$name.json" "$@" "${shots[@]}" --method path-integration -o "$name-pi.png" 2>/dev/null
    "$opaline" reference "$name-printed.json" "$@" "${shots[@]}" --method path-integration \
        -o "$name-printed.png" 2>/dev/null
    montage -background white -font DejaVu-Sans -pointsize 13 -label "Monte Carlo, $spp paths a pixel" \
        "$name-mc.png" -label "path integration" "$name-pi.png" \
        -label "the paper's formulas as printed" "$name-printed.png" \
        -label "Monte Carlo, as wrong: $equal a pixel" "$name-same.png" -tile 4x1 -geometry +3+3 \
        -depth 8 "$out/volumes$n.png"
}
figure 4 milk "milk block" --light sun:70,40
figure 5 noise "noise, Gaussian phase" --light sun:220,20 --fov 22
figure 6 cumulus "cloud, skylight" --light sky:3,35
