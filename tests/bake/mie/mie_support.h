#pragma once

#include <gtest/gtest.h>

#include <complex>
#include <map>
#include <numbers>
#include <tuple>

#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/refractive_index.h"
#include "bake/physics/mie/sphere_scattering.h"

namespace opaline::tests {

inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kSphere =
    4 * std::numbers::pi;  ///< tables state 4 pi times our phase function

/// The droplets of [Bouthors2006].
inline bake::DropletDistribution paper_droplets() {
    return {.density = 3e8, .effective_radius = 7e-6, .gamma = 2};
}

inline std::complex<double> water_at(double nm) {
    const auto index = bake::refractive_index(bake::Substance::water, nm * 1e-9);
    EXPECT_TRUE(index.has_value()) << nm;
    return index ? index.value() : 1.333;
}

/// Means over the droplets of the literature, computed once in a process for each wavelength.
inline const bake::DropletOptics& paper_optics(double nm, std::complex<double> index) {
    static std::map<std::tuple<double, double, double>, bake::DropletOptics> known;
    const std::tuple key(nm, index.real(), index.imag());
    if (const auto found = known.find(key); found != known.end()) return found->second;
    auto optics = bake::average_droplets(paper_droplets(), nm * 1e-9, index, {}, {});
    EXPECT_TRUE(optics.has_value()) << nm;
    return known[key] = optics ? std::move(*optics) : bake::DropletOptics{};
}
inline const bake::DropletOptics& paper_optics(double nm) {
    return paper_optics(nm, water_at(nm));
}

/// Light scattered by the angle theta, perpendicular (S_1) and parallel (S_2) to the plane of
/// scattering, straight from the definition: |S_1|^2 + |S_2|^2 over 2 k^2 C_sca is the phase
/// function.
struct MieAmplitudes {
    std::complex<double> s1, s2;
};
inline MieAmplitudes sum_amplitudes(const bake::MieSeries& series, double cosine) {
    MieAmplitudes sum;
    double before = 0, now = 1;  // pi_{n-1}, pi_n
    for (std::size_t i = 0; i < series.a.size(); ++i) {
        const auto n = static_cast<double>(i + 1);
        const double tau = n * cosine * now - (n + 1) * before;
        const double scale = (2 * n + 1) / (n * (n + 1));
        sum.s1 += scale * (series.a[i] * now + series.b[i] * tau);
        sum.s2 += scale * (series.a[i] * tau + series.b[i] * now);
        const double next = ((2 * n + 1) * cosine * now - (n + 1) * before) / n;
        before = now;
        now = next;
    }
    return sum;
}

/// Small droplets, whose mean takes milliseconds.
inline bake::DropletDistribution fine_droplets() {
    return {.density = 1e9, .effective_radius = 0.4e-6, .gamma = 6};
}

inline const bake::DropletOptics& fine_optics() {
    static const bake::DropletOptics optics =
        bake::average_droplets(fine_droplets(), 550e-9, {1.45, 0.01}, {}, {}).value();
    return optics;
}

}  // namespace opaline::tests
