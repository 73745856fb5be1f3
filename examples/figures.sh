#!/usr/bin/env bash
# Remakes Figures 4 to 8 of [Wang2005] with this program, on the statue and on balls.
# usage: figures.sh OUT_DIR [OPALINE]     OPALINE: the program, default build/opaline
# Needs the Debian packages imagemagick, gnuplot-nox, fonts-dejavu-core and perl beside Opaline.
# Bakes are drafts and take about 15 minutes of CPU time. FIGURES_QUALITY=preview in the environment
# makes the pictures of marble, jade and wax as in images/ and takes twice as long.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: figures.sh OUT_DIR [OPALINE]" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
opaline=$(realpath "${2:-$root/build/opaline}")
work="$out/work"
mkdir -p "$work"
cd "$work"
for tool in convert montage gnuplot perl; do
    command -v "$tool" >/dev/null || { echo "figures.sh: $tool is missing (see the head of this script)" >&2; exit 4; }
done

# NAME KEYS: a media file for every material but the floor.
media() { echo "{\"materials\": {\"Floor\": {\"opaque\": true}, \"*\": {$2}}}" >"$1.json"; }
# SCENE NAME OPTIONS...: NAME.opal from SCENE.gltf and NAME.json.
bake() { "$opaline" bake "$1.gltf" --media "$2.json" -o "$2.opal" "${@:3}" 2>/dev/null; }
# FILE NAME OPTIONS...: the picture NAME.png of FILE.opal.
picture() { "$opaline" render "$1.opal" -o "$2.png" "${@:3}"; }
# NAME TILES (FILE LABEL)...: the pictures side by side in OUT_DIR/NAME.png.
panel() {
    local target="$out/$1.png" tiles=$2 arguments=()
    shift 2
    while [ $# -gt 0 ]; do
        arguments+=(-label "$2" "$1.png")
        shift 2
    done
    montage -background white -font DejaVu-Sans -pointsize 15 "${arguments[@]}" -tile "$tiles" \
        -geometry +3+3 -depth 8 "$target"
    echo "$target"
}

"$opaline" example statue -o . >/dev/null
# A ball of 20 mm in radius; latitudes and longitudes, poles closed.
perl -MMIME::Base64 -e '
    my ($rows, $columns, $radius, $pi) = (48, 96, 0.02, atan2(0, -1));
    my ($position, $normal, $index) = ("", "", "");
    for my $i (0 .. $rows) { for my $j (0 .. $columns - 1) {
        my ($t, $f) = ($pi * $i / $rows, 2 * $pi * $j / $columns);
        my @n = (sin($t) * sin($f), cos($t), sin($t) * cos($f));
        $normal .= pack("f<3", @n);
        $position .= pack("f<3", map { $radius * $_ } @n);
    } }
    for my $i (0 .. $rows - 1) { for my $j (0 .. $columns - 1) {
        my ($a, $b) = ($i * $columns + $j, $i * $columns + ($j + 1) % $columns);
        $index .= pack("V3", $a, $a + $columns, $b + $columns) if $i < $rows - 1;
        $index .= pack("V3", $a, $b + $columns, $b) if $i > 0;
    } }
    my ($p, $x, $count) = (length($position), length($index), ($rows + 1) * $columns);
    my $data = encode_base64($position . $normal . $index, "");
    my $all = 2 * $p + $x;
    my $corners = $x / 4;
    print qq({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "materials": [{"name": "Ball"}], "meshes": [{"primitives": [
{"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": 2, "material": 0}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": $count, "type": "VEC3",
"min": [-$radius, -$radius, -$radius], "max": [$radius, $radius, $radius]},
{"bufferView": 1, "componentType": 5126, "count": $count, "type": "VEC3"},
{"bufferView": 2, "componentType": 5125, "count": $corners, "type": "SCALAR"}],
"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": $p},
{"buffer": 0, "byteOffset": $p, "byteLength": $p}, {"buffer": 0, "byteOffset": @{[2 * $p]}, "byteLength": $x}],
"buffers": [{"byteLength": $all, "uri": "data:application/octet-stream;base64,$data"}]})' >ball.gltf

# The medium of the paper's bird; its unit is not stated there. Taken as 1/cm the light goes deep into
# a statue 12 cm high, and what scatters once can be seen.
bird='"sigma_s": [0.075, 0.085, 0.100], "sigma_a": [0.002, 0.004, 0.007], "unit": "1/mm", "eta": 1.3'
phase() { echo "\"phase\": {\"type\": \"hg\", \"g\": $1}"; }
# The paper's method.
draft=(--quality draft --samples 10000 --multiple-model dipole)
view=(--size 400x400 --fov 22)
back=(--light sky:3,20 --rotate-light 205)

# Figure 5: Henyey-Greenstein, light from behind. 4 terms leave 13 % RMS of the function out.
for g in -0.25 0.25; do
    media "hg$g" "$bird, $(phase $g)"
    bake statue "hg$g" "${draft[@]}" --phase-terms 4 --separate-terms
    picture "hg$g" "single$g" "${view[@]}" "${back[@]}" --terms single --exposure 2
    picture "hg$g" "all$g" "${view[@]}" "${back[@]}"
done
panel figure5 4x1 single-0.25 "g = -0.25, single, 4 x" single0.25 "g = +0.25, single, 4 x" \
    all-0.25 "g = -0.25, all" all0.25 "g = +0.25, all"

# Figure 4: the components, of the bake for g = +0.25.
for terms in multiple single specular; do
    picture hg0.25 "$terms" "${view[@]}" "${back[@]}" --terms "$terms" --exposure "$([ $terms = single ] && echo 2 || echo 0)"
done
panel figure4 4x1 multiple "multiple scattering" single "single scattering, 4 x" \
    specular "specular reflection" all0.25 "all, with the diffuse floor"

# Figure 6: terms of the phase function on balls, with the sun 90 and 160 degrees from the eye.
# K = 1, 4, 9, 16: the paper's 8 cuts the multiplet of degree 2, and the result depends on how that
# is rotated. 25 terms stand for the function itself: 0.3 % RMS.
ks=(1 4 9 16 25)
for k in "${ks[@]}"; do
    media "k$k" "$bird, $(phase 0.25)"
    bake ball "k$k" --quality preview --effects single --phase-terms "$k" --separate-terms
    for azimuth in 90 160; do
        picture "k$k" "k$k-$azimuth" --size 240x240 --fov 20 --eye 0,0,0.15 --target 0,0,0 \
            --light "sun:$azimuth,15" --terms single --exposure 3
    done
done
arguments=()
for azimuth in 90 160; do
    for k in "${ks[@]}"; do
        arguments+=("k$k-$azimuth" "K = $k, $azimuth degrees")
    done
done
panel figure6-balls 5x2 "${arguments[@]}"
for g in 0.1 0.25 0.4 0.6 0.8; do
    "$opaline" phase --g "$g" --samples 361 --format csv >"phase$g.csv"
done
gnuplot <<'PLOT'
set datafile separator ","
set terminal pngcairo size 1100,460 font "DejaVu Sans,11"
set output "plots.png"
set multiplot layout 1,2
set title "Henyey-Greenstein g = 0.25 and its first K terms"
set xlabel "angle between propagation directions [degrees]"
set ylabel "4 pi p"
set xrange [0:180]
set xtics 30
g = 0.25
p0(x) = 1
p1(x) = 3*g*x
p2(x) = 5*g**2*(3*x**2 - 1)/2
p3(x) = 7*g**3*(5*x**3 - 3*x)/2
c(a) = cos(a*pi/180)
plot "< grep '^p,' phase0.25.csv" using (acos($2 > 1 ? 1 : $2 < -1 ? -1 : $2)*180/pi):(4*pi*$3) with lines lw 3 lc rgb "#bbbbbb" title "the function", \
     p0(c(x)) lw 1.5 title "K = 1", p0(c(x)) + p1(c(x)) lw 1.5 title "K = 4", \
     p0(c(x)) + p1(c(x)) + p2(c(x)) lw 1.5 title "K = 9", \
     p0(c(x)) + p1(c(x)) + p2(c(x)) + p3(c(x)) lw 1.5 dt 2 lc rgb "black" title "K = 16"
set title "Left out by K terms: SVD (lines), harmonics (points)"
set xlabel "K"
set ylabel "relative RMS error"
set xrange [1:25]
set xtics 1,3
set yrange [1e-5:1]
set logscale y
set format y "10^{%T}"
set key bottom left
files = "0.8 0.6 0.4 0.25 0.1"
full(k) = k == 1 || k == 4 || k == 9 || k == 16 || k == 25
plot for [i=1:5] "< grep '^rms_svd' phase".word(files, i).".csv" using 2:3 with lines lw 1.5 lc i title "g = ".word(files, i), \
     for [i=1:5] "< grep '^rms_harmonics,' phase".word(files, i).".csv" using (full($2) ? $2 : NaN):3 with points pt 7 lc i notitle
PLOT
cp plots.png "$out/figure6-plots.png"
echo "$out/figure6-plots.png"

# Figure 7: points along the inward normal, 16 against 128, both evenly spread in what they weigh:
# the paper compares 16 such with 128 random ones. 128 are slow, so the cube map is the smallest.
# The difference is shown 16 times.
media depth "$bird"
for n in 16 128; do
    bake statue depth "${draft[@]}" --cubemap 8 --effects single --depth-samples "$n" --separate-terms
    picture depth "depth$n" "${view[@]}" "${back[@]}" --terms single --exposure 2
done
convert depth16.png depth128.png -compose difference -composite -evaluate multiply 16 difference.png
panel figure7 3x1 depth16 "16 samples, 4 x" depth128 "128 samples, 4 x" difference "difference, 16 x of that"

# Its other half: along the normal, which is the same from everywhere and can be baked, against along
# the refracted ray of sight, as `opaline reference` traces it. From radiance, not tone-mapped.
small=(--light studio --size 300x300 --fov 22 --terms single)
bake statue depth "${draft[@]}" --effects single --separate-terms
picture_exr() { convert "$1.exr" -evaluate multiply 4 -depth 8 "$1.png"; }
"$opaline" render depth.opal "${small[@]}" -o normal.exr
"$opaline" reference statue.gltf --media depth.json "${small[@]}" --spp 2048 -o sight.exr 2>/dev/null
picture_exr normal
picture_exr sight
panel figure7-path 2x1 normal "along the normal (baked), 4 x" sight "along the line of sight (traced), 4 x"

# Figure 8 and the showpiece: marble with veins, jade and wax.
for name in marble jade wax; do
    cp "$root/examples/media/$name.json" .
    bake statue "$name" --quality "${FIGURES_QUALITY:-draft}"
    picture "$name" "$name" --size 440x440 --fov 16.5 --light sky:3,20 --rotate-light 195
done
picture marble marble-front --size 440x440 --fov 16.5 --light sky:3,35
panel figure8 2x1 marble-front "sun from the front" marble "sun from behind"
montage marble.png jade.png wax.png -tile 3x1 -geometry +0+0 -depth 8 "$out/materials.png"
echo "$out/materials.png"

# Thin-walled leaves with the sun behind the eye and behind them.
"$opaline" example leaves -o . >/dev/null
"$opaline" bake leaves.gltf --media "$root/examples/media/leaf.json" -o leaves.opal 2>/dev/null
for sun in 20 200; do
    picture leaves "leaves$sun" --size 640x440 --distance 0.26 --azimuth 20 --elevation 25 \
        --target 0,0.04,0 --light sky:3,20 --rotate-light "$sun"
done
montage leaves20.png leaves200.png -tile 2x1 -geometry +0+0 -depth 8 "$out/leaves.png"
echo "$out/leaves.png"
