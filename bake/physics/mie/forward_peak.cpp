#include "bake/physics/mie/forward_peak.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "bake/physics/phase.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

constexpr double kEndSlope = 0.44;  // -d(log P)/d(angle) [1/degree]

/// -d(log P)/d(angle) [1/degree] over a window of 10 % of the angle: narrower ones see the noise of
/// a mean over droplets.
double descent(const AngularTable& phase, double angle) {
    const double from = 0.95 * angle, to = 1.05 * angle;
    return std::log(eval_table(phase, from) / eval_table(phase, to)) / ((to - from) * 180 / pi);
}

}  // namespace

double find_peak_angle(const AngularTable& phase) {
    // Steps of 1 % of the angle, from a tenth of the first row on.
    bool steep = false;
    for (double angle = 0.1 * phase.angle[1]; angle < pi / 2; angle *= 1.01) {
        const double slope = descent(phase, angle);
        if (steep && slope < kEndSlope) {
            // Between two steps the slope is nearly linear.
            const double before = descent(phase, angle / 1.01);
            return angle / 1.01 * (1 + 0.01 * (before - kEndSlope) / (before - slope));
        }
        steep = steep || slope >= kEndSlope;
    }
    return 0;
}

PeakSplit split_peak(const AngularTable& phase, double angle) {
    assert(angle >= 0 && angle <= pi / 2);
    PeakSplit split;
    if (angle <= 0) {
        split.rest = phase;
        return split;
    }
    split.angle = angle;
    split.peak = cut_table(phase, 0, angle);
    split.rest = cut_table(phase, angle, pi);
    const double inside = integrate_table(split.peak), outside = integrate_table(split.rest);
    split.weight = inside / (inside + outside);
    scale_table(split.peak, 1 / inside);
    scale_table(split.rest, 1 / outside);
    return split;
}

double rest_extinction(const PeakSplit& split, double kappa) {
    return (1 - split.weight) * kappa;
}

std::vector<double> forward_glow(const PeakSplit& split, std::span<const double> moments,
                                 double events, std::span<const double> angles) {
    std::vector<double> glow(angles.size(), 0.0);
    if (split.weight <= 0 || !(events > 0)) return glow;
    const double once = events * std::exp(-events), share = scattered_share(0, events);
    std::vector<double> rest;
    rest.reserve(moments.size());
    for (const double moment : moments) {
        rest.push_back(share * moment_after_many(moment, events) - once * moment);
    }
    for (std::size_t i = 0; i < angles.size(); ++i) {
        glow[i] = once * eval_table(split.peak, angles[i]) + eval_zonal(rest, std::cos(angles[i]));
    }
    return glow;
}

double forward_glow(const PeakSplit& split, std::span<const double> moments, double events,
                    double angle) {
    return forward_glow(split, moments, events, std::span(&angle, 1)).front();
}

SelfConvolution convolve_with_itself(const AngularTable& phase, unsigned moments,
                                     std::span<const double> angles) {
    std::vector<double> squares = table_moments(phase, moments);
    for (double& moment : squares) {
        moment *= moment;
    }
    SelfConvolution result;
    result.table.angle.assign(angles.begin(), angles.end());
    result.table.value = sum_moments(squares, angles);
    result.lowest = *std::min_element(result.table.value.begin(), result.table.value.end());
    for (double& value : result.table.value) {
        value = std::max(0.0, value);
    }
    result.integral = integrate_table(result.table);
    scale_table(result.table, 1 / result.integral);
    return result;
}

}  // namespace opaline::bake
