#!/usr/bin/env bash
# Remakes figures of [Bouthors2006] with this program: 3 and 4 (droplets and what they do to light), 6 (orders of
# scattering), 8 and 9 (models against adding and doubling, by order and by direction), 10 and 11 (fogbow, glory, pseudo-specular light,
# back-lit edges, sunset from above, water and ice beneath a layer), these also with the formulas that the paper prints.
# usage: clouds.sh OUT_DIR [OPALINE]     OPALINE: the program, default build/opaline
# Needs the Debian packages imagemagick, fonts-dejavu-core and perl beside Opaline. Plots are SVG, with the numbers as CSV.
# CLOUDS_SIZE=WxH in the environment sets the size of pictures.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
[ $# -ge 1 ] || { echo "usage: clouds.sh OUT_DIR [OPALINE]" >&2; exit 2; }
mkdir -p "$1"
out=$(realpath "$1")
opaline=$(realpath "${2:-$root/build/opaline}")
size=${CLOUDS_SIZE:-480x320}
mkdir -p "$out/work"
cd "$out/work"
for tool in convert montage perl; do
    command -v "$tool" >/dev/null || { echo "clouds.sh: $tool is missing (see the head of this script)" >&2; exit 4; }
done

# The paper's droplets.
droplets=(--effective-radius 7um --gamma 2)
density=3e8

# FILE TITLE X-AXIS TICKS LOG: OUT_DIR/FILE.svg of FILE.csv, columns x,name,name,...; LOG = 1: logarithmic y.
plot() {
    perl -e '
        my ($file, $title, $axis, $ticks, $log) = @ARGV;
        open my $in, "<", "$file.csv" or die; chomp(my $head = <$in>);
        my (undef, @name) = split /,/, $head; my @row = map { chomp; [split /,/, $_, -1] } <$in>;
        my ($w, $h, $l, $t) = (640, 400, 70, 40); my @color = qw(#c33 #292 #23c #777 #c7a #3aa #a83);
        my $f = sub { $log ? log($_[0]) / log(10) : $_[0] };
        my ($x0, $x1) = ($row[0][0], $row[-1][0]); my ($y0, $y1) = (1e300, -1e300);
        for my $r (@row) { for (@$r[1 .. $#$r]) { next if $_ eq "" or ($log and $_ <= 0);
            my $y = $f->($_); $y0 = $y if $y < $y0; $y1 = $y if $y > $y1; } }
        if (!$log) { my $unit = 10 ** int(log($y1) / log(10) - ($y1 < 1)); ($y0, $y1) = (0, $unit * (int($y1 / $unit) + 1)); }
        ($y0, $y1) = (int($y0) - ($y0 < 0), int($y1) + 1) if $log;
        my $px = sub { $l + $w * ($_[0] - $x0) / ($x1 - $x0) }; my $py = sub { $t + $h * ($y1 - $_[0]) / ($y1 - $y0) };
        open my $to, ">", "$file.svg" or die;
        printf $to qq(<svg xmlns="http://www.w3.org/2000/svg" width="%d" height="%d" font-family="sans-serif" font-size="13">\n),
            $w + $l + 230, $h + $t + 60;
        print $to qq(<rect width="100%" height="100%" fill="white"/><text x="$l" y="24" font-size="16">$title</text>\n);
        for my $i (0 .. $ticks) {
            my $x = $x0 + ($x1 - $x0) * $i / $ticks; my $at = $px->($x);
            printf $to qq(<line x1="%.1f" y1="%d" x2="%.1f" y2="%d" stroke="#ddd"/><text x="%.1f" y="%d" text-anchor="middle">%.4g</text>\n),
                $at, $t, $at, $t + $h, $at, $t + $h + 18, $x; }
        my $steps = $log ? $y1 - $y0 : 5;
        for my $i (0 .. $steps) {
            my $y = $y0 + ($y1 - $y0) * $i / $steps; my $at = $py->($y);
            printf $to qq(<line x1="%d" y1="%.1f" x2="%d" y2="%.1f" stroke="#ddd"/><text x="%d" y="%.1f" text-anchor="end">%s</text>\n),
                $l, $at, $l + $w, $at, $l - 6, $at + 4, $log ? "1e$y" : sprintf "%.3g", $y; }
        for my $c (0 .. $#name) {
            my @path; for my $r (@row) { my $v = $r->[$c + 1]; next if $v eq "" or ($log and $v <= 0);
                push @path, sprintf "%.1f,%.1f", $px->($r->[0]), $py->($f->($v)); }
            my $k = $color[$c % @color];
            printf $to qq(<polyline points="%s" fill="none" stroke="%s" stroke-width="1.5"/>\n), join(" ", @path), $k;
            my $at = $t + 12 + 20 * $c;
            printf $to qq(<line x1="%d" y1="%d" x2="%d" y2="%d" stroke="%s" stroke-width="3"/><text x="%d" y="%d">%s</text>\n),
                $l + $w + 12, $at, $l + $w + 32, $at, $k, $l + $w + 38, $at + 4, $name[$c]; }
        printf $to qq(<text x="%d" y="%d" text-anchor="middle">%s</text>\n</svg>\n), $l + $w / 2, $t + $h + 42, $axis;
    ' "$out/$1" "$2" "$3" "$4" "${5:-0}"
    echo "$out/$1.svg"
}

# Figure 3: number of droplets per volume and radius [1/(m^3 um)], n(r) = N0 / (Gamma(gamma) r_n) (r / r_n)^(gamma - 1)
# e^(-r / r_n) with r_n = r_e / (gamma + 2); Gamma(2) = 1.
"$opaline" mie "${droplets[@]}" --density $density --format csv >optics.csv
perl -e 'my ($n, $gamma, $rn) = ($ARGV[0], 2, 7 / 4); print "radius,droplets\n";
    printf "%.2f,%.6g\n", $_ / 10, $n / $rn * ($_ / 10 / $rn) ** ($gamma - 1) * exp(-$_ / 10 / $rn) for 0 .. 200' \
    $density >"$out/figure3.csv"
plot figure3 "Droplets per volume and radius, N0 = 3e8 / m3, r_e = 7 um, gamma = 2" "radius [um]" 10

# Figure 4: phase functions of the droplets at three wavelengths, and of nearly equal drops of 20 um.
for w in 650 550 450; do
    "$opaline" phase --type mie "${droplets[@]}" --wavelength ${w}nm --table-output p$w.txt --format csv \
        >/dev/null 2>&1
done
"$opaline" phase --type mie --effective-radius 20um --gamma 10000 --table-output equal.txt --format csv >/dev/null 2>&1
perl -e '
    my %at; my @name = @ARGV;
    for my $n (@name) { open my $in, "<", "$n.txt" or die; while (<$in>) { my ($c, $v) = split; next if $c eq "cosine";
        push @{$at{$n}}, [180 / 3.14159265358979 * atan2(sqrt(abs(1 - $c * $c)), $c), $v]; } @{$at{$n}} = sort { $a->[0] <=> $b->[0] } @{$at{$n}}; }
    print "degrees,650 nm,550 nm,450 nm,equal drops of 20 um\n"; my %i;
    for my $d (map { $_ / 5 } 0 .. 900) { my @v = map { my $t = $at{$_}; my $i = \($i{$_} //= 0);
        $$i++ while $$i < $#$t - 1 && $t->[$$i + 1][0] < $d; my ($p, $q) = @$t[$$i, $$i + 1];
        my $s = $q->[0] > $p->[0] ? ($d - $p->[0]) / ($q->[0] - $p->[0]) : 0; $s = 0 if $s < 0; $s = 1 if $s > 1;
        exp((1 - $s) * log($p->[1]) + $s * log($q->[1])) } @name;
        printf "%.1f,%s\n", $d, join ",", map { sprintf "%.5g", $_ } @v; }' p650 p550 p450 equal >"$out/figure4.csv"
plot figure4 "Phase functions [1/sr]: droplets of a cloud, and nearly equal drops" "angle [degrees]" 9 1

# Figure 6: what a layer of 100 m reflects and transmits under light 70 degrees from the normal, by order: with the whole
# phase function, and with its forward peak taken for light that goes straight on.
read -r kappa rest angle < <(perl -F, -ane 'if ($. == 1) { chomp @F; @i{@F} = 0 .. $#F } elsif ($F[0] == 5.5e-7) {
    chomp @F; print join(" ", @F[@i{qw(extinction_per_m rest_extinction_per_m forward_angle_deg)}]), "\n" }' optics.csv)
ANGLE=$angle perl -ne '($c, $v) = split; if ($c eq "cosine") { print; next } $edge = cos($ENV{ANGLE} * 3.14159265358979 / 180);
    if ($c < $edge - 1e-6) { print } elsif (!$done++) { print "$edge $v\n", $edge + 1e-6, " 0\n1 0\n" }' \
    <p550.txt >rest.txt
orders() { "$opaline" slab --optical-depth "$1" --phase "$2" --cosine 0.342020 --format csv; }
orders "$(perl -e "print 100 * $kappa")" p550.txt >whole.csv
orders "$(perl -e "print 100 * $rest")" rest.txt >modified.csv
perl -e '
    my %v; for my $f (qw(whole modified)) { open my $in, "<", "$f.csv" or die; while (<$in>) { chomp; my ($q, $o, $x) = split /,/;
        $v{$f}{$q}{$o} = $x; } }
    print "orders up to,reflected,reflected without the peak,transmitted,transmitted without the peak\n"; my @sum;
    for my $o (0 .. 7) { my $i = 0; for my $q (qw(reflectance transmittance)) { for my $f (qw(whole modified)) {
        $sum[$i++] += $v{$f}{$q}{$o}; } } printf "%d,%s\n", $o, join ",", map { sprintf "%.5f", $_ } @sum; }
    printf STDERR "all orders: reflected %.4f, without the peak %.4f\n", map { $v{$_}{reflectance}{all} } qw(whole modified);' \
    >"$out/figure6.csv"
plot figure6 "Shares of light by orders 0 to n: 100 m, light at 70 degrees" "n" 7

# NAME KEY=VALUE...: OUT_DIR/NAME.svg of NAME.csv, panels of curves.
panels() { perl "$root/examples/plot_panels.pl" "$out/$1" "${@:2}"; }
cosine() { perl -e 'printf "%.6f", cos($ARGV[0] * 3.14159265358979 / 180)' "$1"; }
depth() { perl -e 'printf "%.6f", $ARGV[0] * $ARGV[1]' "$rest" "$1"; }

# Figure 8: shares of the light by order, thickness and angle: the one-dimensional model, fitted at each angle, against adding
# and doubling. RMS errors of three distributions of droplets: opaline_bench slab-accuracy prints them (tests/bench).
angles=(0 30 60 80)
for a in "${!angles[@]}"; do
    for h in 3 5 8 13 20 30 50 80 130 200 300 500 800; do
        slab=(--optical-depth "$(depth $h)" --phase rest.txt --cosine "$(cosine "${angles[$a]}")" --streams 24 --format csv)
        "$opaline" slab "${slab[@]}" --method model | sed "s/^/$a,$h,,/"
        "$opaline" slab "${slab[@]}" --orders 3 | sed "s/^/$a,$h,_,/"
    done
done >shares.txt
perl -F, -lane 'BEGIN { print "panel,series,thickness,share" } my ($a, $h, $by, $what, $order, $v) = @F;
    next unless $what eq "reflectance" || $what eq "transmittance"; next if $what eq "reflectance" && $order eq "0";
    my $panel = $a + ($what eq "reflectance" ? 4 : 0); print join ",", $panel, ($order eq "all" ? "all" : "order $order") . $by, $h, $v' \
    <shares.txt >"$out/figure8.csv"
panels figure8 columns=4 log=x low=0 high=1 ticks=3,10,30,100,300,800 x="thickness [m]" y="share of the light" \
    title="Shares of the light by order: one-dimensional model (lines), adding and doubling (dots); droplets of 7 um" \
    "panels=transmitted, light at 0 degrees|at 30 degrees|at 60 degrees|at 80 degrees|reflected, light at 0 degrees|at 30 degrees|at 60 degrees|at 80 degrees" \
    "series=order 0:#777:line|order 1:#c33:line|order 2:#e90:line|order 3+:#23c:line|all:#111:line|order 0_:#777:dots|order 1_:#c33:dots|order 2_:#e90:dots|order 3+_:#23c:dots|all_:#111:dots"

# Figure 9: radiance in the plane of light and normal, of scattered light, by the table that renderers read and by the compact
# model (orders 1 and 2 in closed form, the rest by the model's energy and one profile), against adding and doubling.
case=0
for view in 100:70 5:80 100:30; do
    slab=(--optical-depth "$(depth "${view%:*}")" --phase rest.txt --cosine "$(cosine "${view#*:}")" --views 90 --format csv)
    for method in adding table model; do
        "$opaline" slab "${slab[@]}" --method $method | sed "s/^/$case,$method,/"
    done
    case=$((case + 1))
done >radiances.txt
perl -F, -lane 'BEGIN { print "panel,series,degrees,radiance" } my ($c, $by, $x, $side, $order, $v) = @F; next unless $v =~ /^[0-9]/;
    my %name = (adding => "adding and doubling", table => "table (default)", model => "compact model");
    my $name = $order eq "all" ? $name{$by} : $by eq "adding" && $order ne "2+" ? "order $order of it" : next;
    print join ",", $c + ($side eq "transmitted" ? 3 : 0), $name, $x, $v' <radiances.txt >"$out/figure9.csv"
panels figure9 columns=3 log=y low=0.01 high=30 ticks=-90,-60,-30,0,30,60,90 x="view [degrees from the normal]" \
    y="radiance over that of a white surface" \
    title="Scattered light by direction, droplets of 7 um; light comes from the left, below 0 degrees" \
    "panels=reflected: 100 m, light at 70 degrees|5 m, at 80 degrees|100 m, at 30 degrees|transmitted: 100 m, light at 70 degrees|5 m, at 80 degrees|100 m, at 30 degrees" \
    "series=order 1 of it:#999:dash|order 2 of it:#e90:dash|order 3+ of it:#292:dash|adding and doubling:#111:dots|table (default):#c33:line|compact model:#23c:line"

# NAME JSON OPTIONS...: NAME.opal of one layer.
layer() {
    echo "{\"clouds\": [{$2}]}" >"$1.json"
    "$opaline" bake "$1.json" -o "$1.opal" "${@:3}" 2>"$1.log"
}
# FILE NAME OPTIONS...: the picture NAME.png; the sun of `sky` stands at the azimuth -40 and is turned to 180, toward -Z.
picture() { "$opaline" render "$1.opal" -o "$2.png" --size "$size" --rotate-light -140 "${@:3}"; }
# NAME TILES (FILE LABEL)...: the pictures side by side in OUT_DIR/NAME.png.
panel() {
    local target="$out/$1.png" tiles=$2 arguments=()
    shift 2
    while [ $# -gt 0 ]; do
        arguments+=(-label "$2" "$1.png")
        shift 2
    done
    montage -background white -font DejaVu-Sans -pointsize 15 "${arguments[@]}" -tile "$tiles" -geometry +3+3 -depth 8 "$target"
    echo "$target"
}
cells='"procedural": {"type": "cellular", "scale": 1500, "seed": 4}, "thickness": 300, "repeat": true, "size": [12000, 12000]'
broken='"procedural": {"type": "cellular", "scale": 1200, "coverage": 0.6}, "thickness": 180, "repeat": true, "size": [12000, 12000]'

# Figure 10: away from a sun 50 degrees high. The fogbow is 38 degrees from the point opposite the sun, the glory 2. A thin
# layer over dark water shows them best: much of its light was scattered once.
layer cells "$cells"
layer thin '"thickness": 25, "repeat": true, "ground_albedo": [0.02, 0.03, 0.04]'
picture thin fogbow --light sky:2,50 --eye 0,3000,0 --target 0,2233.96,642.79 --fov 95 --exposure 1.3
picture thin glory --light sky:2,50 --eye 0,3000,0 --target 0,2233.96,642.79 --fov 14 --exposure 1.3
layer thin-paper '"thickness": 25, "repeat": true, "ground_albedo": [0.02, 0.03, 0.04], "fidelity": "paper"'
picture thin-paper fogbow-paper --light sky:2,50 --eye 0,3000,0 --target 0,2233.96,642.79 --fov 95 --exposure 1.3
picture thin-paper glory-paper --light sky:2,50 --eye 0,3000,0 --target 0,2233.96,642.79 --fov 14 --exposure 1.3
# Toward a low sun the same layer shines as a mirror would, without being one.
picture thin mirror --light sky:3,12 --eye 0,2000,0 --target 0,1985,-100 --fov 60 --exposure -2
panel figure10 3x1 fogbow "fogbow and glory from above" glory "glory" mirror "toward a low sun: pseudo-specular"
panel figure10-fidelity 2x2 fogbow "physical: fogbow and glory" glory "physical: glory" \
    fogbow-paper "paper: fogbow and glory" glory-paper "paper: glory"

# Figure 11: toward the sun through broken clouds, sunset from above, and a ground that is half water, half ice.
layer broken "$broken, \"visibility\": 60000"
layer broken-paper "$broken, \"visibility\": 60000, \"fidelity\": \"paper\""
layer cells-paper "$cells, \"fidelity\": \"paper\""
for f in "" -paper; do
    picture broken$f backlit$f --light sky:3,28 --eye 0,1.7,0 --target 0,22,-50 --fov 40 --exposure -1.3
    picture broken$f day$f --light sky:3,50 --eye 0,1.7,0 --target 0,22,50 --fov 50
    picture cells$f noon$f --light sky:3,50 --eye 0,2600,0 --target 0,2550,-100 --fov 50
    picture cells$f sunset$f --light sky:5,6 --eye 0,2600,0 --target 0,2550,-100 --fov 50 --exposure -1
done
panel figure11 2x2 backlit "toward the sun, from below" day "full daylight, from below" \
    noon "full daylight, from above" sunset "sunset, from above"
panel figure11-fidelity 2x4 backlit "physical: toward the sun, from below" backlit-paper "paper" \
    day "physical: full daylight, from below" day-paper "paper" noon "physical: full daylight, from above" noon-paper "paper" \
    sunset "physical: sunset, from above" sunset-paper "paper"
convert -size 1024x16 xc:'srgb(60,60,66)' -size 1024x16 xc:'srgb(231,233,235)' +append ground.png
shores='"procedural": {"type": "waves", "scale": 1500}, "thickness": 250, "repeat": false, "size": [20000, 20000], "ground": "ground.png"'
layer with "$shores"
layer without "$shores" --effects cloud
for n in with without; do
    picture "$n" "shores-$n" --light sky:3,45 --eye 0,60,3000 --target 0,78,2950 --fov 75 --exposure -0.5
done
panel figure11-ground 1x2 shores-with "water and ice: light between ground and clouds" shores-without "without that light"
