#include "bake/sweep/slopes.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

// From the fine end, rungs that are hardly closer than the one before: something else is what errs.
std::size_t count_unsaturated(std::span<const Convergence> rungs) {
    constexpr double kLeastGain = 0.9;
    std::size_t count = rungs.size();
    while (count >= 2 && rungs[count - 1].error > kLeastGain * rungs[count - 2].error) {
        --count;
    }
    return count;
}

}  // namespace

std::optional<Slope> fit_slope(std::span<const Convergence> rungs, bool semi_log) {
    std::vector<Convergence> useful;
    for (const Convergence& rung : rungs) {
        if (rung.error > 0 && (semi_log || rung.value > 0)) {
            useful.push_back(rung);
        }
    }
    const std::size_t count = count_unsaturated(useful);
    if (count < 2) {
        return std::nullopt;
    }
    Slope fit;
    double mean_x = 0, mean_y = 0;
    std::vector<double> x, y;
    for (std::size_t i = 0; i < useful.size(); ++i) {
        if (i >= count) {
            fit.saturated.push_back(useful[i].value);
            continue;
        }
        fit.used.push_back(useful[i].value);
        x.push_back(semi_log ? useful[i].value : std::log(useful[i].value));
        y.push_back(std::log(useful[i].error));
        mean_x += x.back() / static_cast<double>(count);
        mean_y += y.back() / static_cast<double>(count);
    }
    double xx = 0, xy = 0;
    for (std::size_t i = 0; i < count; ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (xx == 0) {
        return std::nullopt;
    }
    fit.slope = xy / xx;
    fit.intercept = mean_y - fit.slope * mean_x;
    double residual = 0;
    for (std::size_t i = 0; i < count; ++i) {
        const double r = y[i] - fit.intercept - fit.slope * x[i];
        residual += r * r;
    }
    if (count > 2) {
        fit.standard_error = std::sqrt(residual / static_cast<double>(count - 2) / xx);
    }
    return fit;
}

std::optional<Theory> convergence_theory(Ladder ladder, double g) {
    switch (ladder) {
        case Ladder::resolution:
            return Theory{-1, false, "cube map size N",
                          "a small light's place is known to a texel: error in proportion to 1/N"};
        case Ladder::coefficients:
            return Theory{
                -0.5, false, "coefficients M",
                "M largest Haar coefficients of a function with edges along curves, in L2 "
                "[DeVore1998]; relit values converge faster, as light has few too"};
        case Ladder::samples:
            return Theory{-1, false, "surface samples",
                          "square of the spacing, where transport is smooth at that scale"};
        case Ladder::tolerance:
            return Theory{
                1, false, "gather tolerance \u03b5",
                "each cluster errs by at most \u03b5 (signs differ, so sums err by less)"};
        case Ladder::depth_samples:
            return Theory{
                -1, false, "depth samples",
                "Gauss-Legendre across the edge of a shadow; faster where light is smooth"};
        case Ladder::single_cubemap:
            return Theory{-1, false, "cube map of single scattering",
                          "a small light's place is known to a texel"};
        case Ladder::phase_terms:
            if (g == 0) {
                return std::nullopt;
            }
            return Theory{std::log(std::abs(g)), true, "degree of the phase function",
                          "Legendre coefficients of a Henyey-Greenstein function: g to the degree"};
        case Ladder::reference_samples:
            return Theory{-0.5, false, "samples of the Monte Carlo reference",
                          "independent paths, whose variances add"};
        default:
            return std::nullopt;
    }
}

}  // namespace opaline::bake
