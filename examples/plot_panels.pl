#!/usr/bin/env perl
# Draws panels of curves side by side as SVG.
# usage: plot_panels.pl FILE KEY=VALUE...: FILE.svg of FILE.csv, whose lines are panel,series,x,y; panels and series in the
# order of KEYs, curves of a series in the order of their lines.
#   title=TEXT  columns=N  x=TEXT  y=TEXT (of the axes)  panels=NAME|NAME|...
#   series=NAME:COLOR:KIND|...  KIND: line, dash or dots
#   log=x, y or xy  low=Y high=Y (of all panels)  ticks=X,X,... (of x)
# Series whose names end in _ have no place in the legend.
use strict;
use warnings;
use List::Util qw(min max);

my ($file, @settings) = @ARGV;
my %set = (columns => 1, log => "", title => "", x => "", y => "", ticks => "");
for (@settings) { my ($key, $value) = /^(\w+)=(.*)$/s or die "plot_panels.pl: no KEY=VALUE: $_\n"; $set{$key} = $value; }
my @panel = split /\|/, $set{panels};
my @series = map { my ($name, $color, $kind) = split /:/; { name => $name, color => $color, kind => $kind } } split /\|/, $set{series};
my @tick = split /,/, $set{ticks};
open my $in, "<", "$file.csv" or die "plot_panels.pl: $file.csv: $!\n";
scalar <$in>;
my %curve;
while (<$in>) { chomp; my ($panel, $series, $x, $y) = split /,/; push @{$curve{$panel}{$series}}, [$x, $y]; }

my $by = sub { my ($axis, $v) = @_; $set{log} =~ /$axis/ ? log($v) / log(10) : $v };
my @all = map { @$_ } map { values %$_ } values %curve;
@all = grep { $set{log} !~ /y/ || $_->[1] > 0 } @all;
my ($x0, $x1) = (min(map { $_->[0] } @all), max(map { $_->[0] } @all));
my $low = $set{low} // min(map { $_->[1] } @all);
my $high = $set{high} // max(map { $_->[1] } @all);
my ($left, $gap, $w, $h) = (66, 26, 250, 210);
my $right = $left + $set{columns} * ($w + $gap);

# The legend stands in lines above the panels.
my ($at, $line, @legend) = ($left, 48);
for my $s (grep { $_->{name} !~ /_$/ } @series) {
    my $wide = 54 + 7.4 * length($s->{name});
    ($at, $line) = ($left, $line + 20) if $at + $wide > $right;
    push @legend, [$s, $at, $line];
    $at += $wide;
}
my $top = $line + 44;
my $rows = int((@panel + $set{columns} - 1) / $set{columns});
my ($width, $height) = ($right, $top + $rows * ($h + 62) + 6);
open my $out, ">", "$file.svg" or die "plot_panels.pl: $file.svg: $!\n";
print $out qq(<svg xmlns="http://www.w3.org/2000/svg" width="$width" height="$height" font-family="DejaVu Sans, sans-serif" font-size="12">\n);
print $out qq(<rect width="100%" height="100%" fill="white"/><text x="$left" y="26" font-size="16">$set{title}</text>\n);

for (@legend) {
    my ($s, $x, $y) = @$_;
    mark($s, [[$x, $y], [$x + 26, $y]]);
    printf $out qq(<text x="%d" y="%d">%s</text>\n), $x + 32, $y + 4, $s->{name};
}

for my $i (0 .. $#panel) {
    my ($ox, $oy) = ($left + ($i % $set{columns}) * ($w + $gap), $top + int($i / $set{columns}) * ($h + 62));
    my $px = sub { $ox + $w * ($by->("x", $_[0]) - $by->("x", $x0)) / ($by->("x", $x1) - $by->("x", $x0)) };
    my $py = sub { $oy + $h * ($by->("y", $high) - $by->("y", $_[0])) / ($by->("y", $high) - $by->("y", $low)) };
    print $out qq(<text x="@{[$ox + 2]}" y="@{[$oy - 8]}" font-weight="bold">$panel[$i]</text>\n);
    for my $x (@tick) {
        printf $out qq(<line x1="%.1f" y1="%d" x2="%.1f" y2="%d" stroke="#e4e4e4"/><text x="%.1f" y="%d" text-anchor="middle">%g</text>\n),
            $px->($x), $oy, $px->($x), $oy + $h, $px->($x), $oy + $h + 16, $x;
    }
    for my $y ($set{log} =~ /y/ ? map { 10 ** $_ } int($by->("y", $low) - 0.001) .. int($by->("y", $high) + 0.001)
        : map { $low + ($high - $low) * $_ / 5 } 0 .. 5) {
        next if $y < $low * 0.999 || $y > $high * 1.001;
        printf $out qq(<line x1="%d" y1="%.1f" x2="%d" y2="%.1f" stroke="#e4e4e4"/>\n), $ox, $py->($y), $ox + $w, $py->($y);
        printf $out qq(<text x="%d" y="%.1f" text-anchor="end">%.3g</text>\n), $ox - 5, $py->($y) + 4, $y if $i % $set{columns} == 0;
    }
    print $out qq(<rect x="$ox" y="$oy" width="$w" height="$h" fill="none" stroke="#888"/>\n);
    for my $s (@series) {
        # A curve ends where it leaves the panel.
        my @part = ([]);
        for (@{$curve{$i}{$s->{name}} // []}) {
            if ($_->[1] < $low - 1e-6 || $_->[1] > $high + 1e-6) { push @part, []; next; }
            push @{$part[-1]}, [$px->($_->[0]), $py->($_->[1])];
        }
        mark($s, $_) for grep { @$_ } @part;
    }
    printf $out qq(<text x="%d" y="%d" text-anchor="middle">%s</text>\n), $ox + $w / 2, $oy + $h + 34, $set{x}
        if $i >= @panel - $set{columns};
    printf $out qq(<text transform="translate(16 %d) rotate(-90)" text-anchor="middle">%s</text>\n), $oy + $h / 2, $set{y}
        if $i % $set{columns} == 0;
}
print $out "</svg>\n";
print "$file.svg\n";

# A curve through points of the picture.
sub mark {
    my ($s, $points) = @_;
    if ($s->{kind} eq "dots") {
        my @shown = @$points == 2 && $points->[0][1] == $points->[1][1] ? ([($points->[0][0] + $points->[1][0]) / 2, $points->[0][1]]) : @$points;
        printf $out qq(<circle cx="%.1f" cy="%.1f" r="2.6" fill="%s"/>\n), @$_, $s->{color} for @shown;
        return;
    }
    printf $out qq(<polyline points="%s" fill="none" stroke="%s" stroke-width="1.7"%s/>\n),
        join(" ", map { sprintf "%.1f,%.1f", @$_ } @$points), $s->{color}, $s->{kind} eq "dash" ? ' stroke-dasharray="5 3"' : "";
}
