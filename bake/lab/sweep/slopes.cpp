#include "bake/lab/sweep/slopes.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

// From the fine end, rungs with hardly less error than the one before: another error dominates.
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
    if (count < 2) return std::nullopt;
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
    if (xx == 0) return std::nullopt;
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

std::optional<Theory> convergence_theory(const Ladder& ladder, double g) {
    const KnobTheory& theory = ladder.theory;
    const bool semi_log = theory.rate_by_cosine != nullptr;
    const double rate = semi_log ? theory.rate_by_cosine(g) : theory.rate;
    return rate == 0 ? std::nullopt
                     : std::optional(Theory{rate, semi_log, std::string(theory.label),
                                            std::string(theory.words)});
}

}  // namespace opaline::bake
