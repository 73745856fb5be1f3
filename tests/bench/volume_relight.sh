#!/usr/bin/env bash
# What a baked volume saves: for each light, the error of a file relit and marched at SIZE, the seconds that takes, and
# the seconds that `opaline reference` needs for a picture as wrong. usage: volume_relight.sh SCENE OUT_DIR [OPALINE]
# SPP=N in the environment sets the paths per pixel of the run that both are compared with; SIZE=WxH the picture; BAKE the
# options of the bake. Needs perl.
set -euo pipefail
[ $# -ge 2 ] || { echo "usage: volume_relight.sh SCENE OUT_DIR [OPALINE]" >&2; exit 2; }
scene=$(realpath "$1")
mkdir -p "$2"
opaline=$(realpath "${3:-$(dirname "${BASH_SOURCE[0]}")/../../build-release/opaline}")
cd "$2"
size=${SIZE:-512x384}
spp=${SPP:-64}
read -ra bake <<<"${BAKE:---quality preview}"
terms=(--terms volume-single,volume-multiple)

# FILE EXPRESSION: the time that the regular expression captures, in seconds.
seconds() {
    perl -0ne "/$2/ or die qq($1: no match\n); my (\$x, \$u) = (\$1, \$2);
        print \$x * (\$u eq 'ms' ? 1e-3 : \$u =~ /^min/ ? 60 : 1)" "$1"
}
"$opaline" bake "$scene" "${bake[@]}" -o baked.opal 2>bake.log
baked=$(seconds bake.log 'nodes in volumes, ([\d.]+) (ms|s|min)')
echo "| light | error | relight and march, s | Monte Carlo: paths a pixel | s | ratio | lights until the bake has paid |"
echo "|---|---:|---:|---:|---:|---:|---:|"
# LABEL LIGHT: a row. The camera stands at azimuth 30 degrees.
row() {
    local label=$1 light=$2 camera=(--azimuth 30 --elevation 10 --size "$size")
    "$opaline" reference "$scene" "${camera[@]}" --light "$light" "${terms[@]}" --spp "$spp" -o truth.exr 2>truth.log
    "$opaline" render baked.opal "${camera[@]}" --light "$light" "${terms[@]}" --backend cpu --stats -o "baked-$label.exr" \
        >render.log 2>&1
    local noise rms traced shown
    noise=$(perl -0ne '/standard error ([\d.e+-]+) %/ and print $1 / 100' truth.log)
    rms=$("$opaline" compare "baked-$label.exr" truth.exr --json | perl -0ne '/"relative_rmse": *([\d.e+-]+)/ and print $1')
    traced=$(seconds truth.log 'pixels, ([\d.]+) (ms|s|min)')
    shown=$(perl -0ne 'my $s = 0;
        $s += $1 * ($2 eq "ms" ? 1e-3 : 1) while /(?:light vector|dot products|draw per frame) +([\d.]+) (ms|s)\b/g;
        print $s' render.log)
    perl -e 'my ($label, $rms, $noise, $spp, $traced, $shown, $baked) = @ARGV;
        my $e = sqrt(abs($rms**2 - $noise**2)); my $n = $spp * ($noise / $e)**2; my $t = $traced * $n / $spp;
        printf "| %s | %.1f %% | %.3f | %d | %.0f | %.0f | %.2f |\n", $label, 100 * $e, $shown, $n, $t, $t / $shown, $baked / $t' \
        "$label" "$rms" "$noise" "$spp" "$traced" "$shown" "$baked"
}
row behind-the-eye sun:30,30
row side sun:120,30
row ahead sun:210,30
row sky sky:3,35
