#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace opaline::tests {

/// Henyey and Greenstein's function without its forward peak, in closed form:
/// min(p(c), p(edge)) / (1 - peak), peak = g^5, the edge such that the integral is 1.
struct CutPhase {
    double g = 0, peak = 0;
    double edge = 1;  ///< cosine above which it is constant

    double whole(double c) const {
        return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * c, 1.5));
    }
    double operator()(double c) const { return whole(std::min(c, edge)) / (1 - peak); }

    /// Of degrees 0 to 4, as volumes are baked with: (g^l - peak) / (1 - peak).
    std::array<float, 5> moments() const {
        std::array<float, 5> moment{};
        for (std::size_t l = 0; l < moment.size(); ++l) {
            moment[l] = static_cast<float>((std::pow(g, l) - peak) / (1 - peak));
        }
        return moment;
    }
};

/// 0 < g < 1.
inline CutPhase make_cut_phase(double g) {
    CutPhase phase{g, std::pow(g, 5), 1};
    // 2 pi int_c^1 p dcos - p(c) 2 pi (1 - c): what the cut takes away.
    const auto removed = [&](double c) {
        const double above =
            (1 - g * g) / (2 * g) * (1 / (1 - g) - 1 / std::sqrt(1 + g * g - 2 * g * c));
        return above - phase.whole(c) * 2 * std::numbers::pi * (1 - c);
    };
    double low = -1, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (removed(middle) > phase.peak ? low : high) = middle;
    }
    phase.edge = low;
    return phase;
}

}  // namespace opaline::tests
