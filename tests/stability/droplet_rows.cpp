#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

#include "bake/physics/mie/angular_table.h"
#include "bake/physics/mie/droplets.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/phase_texture.h"
#include "bake/physics/phase.h"
#include "formats/opal/half.h"
#include "tests/stability/stability_row.h"

// Distributions of droplets and their phase functions.

namespace opaline::tests {
namespace {

using std::numbers::pi;

// <r^power> / r_n^power of the droplets by the nodes that stand for them.
double moment_by_nodes(double gamma, int power) {
    const bake::DropletDistribution droplets{.gamma = gamma};
    const double r_n = bake::characteristic_radius(droplets);
    double sum = 0;
    for (const bake::RadiusNode& node : bake::place_radii(droplets, 8000)) {
        sum += node.share * std::pow(node.radius / r_n, power);
    }
    return sum;
}

// By even steps from 0 on, of the density as printed.
double textbook_moment_by_nodes(double gamma, int power) {
    const double most = gamma + 12 + 8 * std::sqrt(gamma + 4), step = most / 8000;
    double sum = 0;
    for (int i = 0; i < 8000; ++i) {
        const double t = i * step;
        sum +=
            step * std::pow(t, gamma - 1) * std::exp(-t) / std::tgamma(gamma) * std::pow(t, power);
    }
    return sum;
}

bake::AngularTable peaked_phase(double g) {
    bake::AngularTable table;
    for (int i = 0; i <= 4096; ++i) {
        table.angle.push_back(bake::texture_angle(i / 4096.0));
        table.value.push_back(bake::henyey_greenstein(std::cos(table.angle.back()), g));
    }

    return table;
}

// As a reader of the texture sees it: midpoints, dense where the texels are.
double integrate_texture(const bake::PhaseTexture& texture) {
    constexpr int kSteps = 200000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double a = bake::texture_angle(static_cast<double>(i) / kSteps);
        const double b = bake::texture_angle(static_cast<double>(i + 1) / kSteps);
        sum += 2 * pi * bake::cosine_difference(a, b) * bake::eval_texture(texture, (a + b) / 2);
    }
    return sum;
}

// e^-u sum of (2 l + 1) / (4 pi) e^(u chi_l) P_l(1).
double textbook_glow(const std::vector<double>& moments, double events) {
    double sum = 0;
    for (std::size_t l = 0; l < moments.size(); ++l) {
        sum += static_cast<double>(2 * l + 1) / (4 * pi) * std::exp(events * moments[l]);
    }
    return std::exp(-events) * sum;
}

}  // namespace

StabilityField droplet_rows() {
    const bake::AngularTable peak = peaked_phase(0.99);
    const bake::PhaseTexture coarse = bake::make_phase_texture(peak, 16);
    const bake::PeakSplit cone =
        bake::split_peak({{0, 0.1, 0.1 + 1e-9, pi}, {1, 1, 0.01, 0.01}}, 0.1);
    const std::vector<double> moments = bake::table_moments(cone.peak, bake::kGlowMoments);
    const float ahead = static_cast<float>(bake::henyey_greenstein(1, 0.9975));
    return {
        "Droplets",
        {
            {"Γ(γ) of large γ", "all droplets; γ 1000", "1 / Γ(γ)",
             textbook_moment_by_nodes(1000, 0), moment_by_nodes(1000, 0), "1", 1e-6, 1},
            {"γ < 1", "all droplets' section, r_n 1; γ .1", "r^(γ − 1) from r = 0 on",
             textbook_moment_by_nodes(0.1, 0), moment_by_nodes(0.1, 2), "0.1 * 1.1", 1e-3, 1},
            {"γ → ∞", "all droplets' volume, r_n 1; γ 1e4", "1 / Γ(γ)",
             textbook_moment_by_nodes(1e4, 3), moment_by_nodes(1e4, 3), "mpf(1e4) * 10001 * 10002",
             1e-6, 1},
            {"p of 1e4 at 0°", "HG of g .9975 ahead", "half precision",
             static_cast<double>(formats::float_from_half(formats::half_from_float(ahead))),
             bake::eval_texture(bake::make_phase_texture(peaked_phase(0.9975), 4097), 0) *
                 bake::make_phase_texture(peaked_phase(0.9975), 4097).integral,
             "henyey(1, 0.9975)", 1e-5, 1e-4},
            {"table resampled to texels", "integral; g .99, 16 texels", "as interpolated",
             coarse.integral, integrate_texture(coarse), "1", 1e-5, 0.1},
            {"angles near 0 and 180°", "cos 1e-9 − cos 2e-9", "cos a − cos b",
             std::cos(1e-9) - std::cos(2e-9), bake::cosine_difference(1e-9, 2e-9),
             "2 * sin(mpf(1.5e-9)) * sin(mpf(0.5e-9))", 1e-14, 1},
            {"mean number of scatterings 1e4 in the peak", "what a peak of .1 rad scatters, ahead",
             "e^−u Σ e^(u χ_l)", textbook_glow(moments, 1e4),
             bake::forward_glow(cone, moments, 1e4, 0), "1 / (4 * pi)", 1e-6, 1},
        }};
}

}  // namespace opaline::tests
