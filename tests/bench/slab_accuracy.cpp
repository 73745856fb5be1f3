// How near models and tables of a cloud layer are to adding and doubling, as RESULTS.md states it:
// shares of the flux by order and angle for three droplet distributions, and radiance by direction.
// `opaline_bench slab-accuracy` prints both as markdown; about three minutes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/forward_peak.h"
#include "bake/physics/mie/refractive_index.h"
#include "bake/physics/slab/column_model.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/radiance_table.h"
#include "bake/physics/slab/solve_radiance.h"
#include "bake/physics/slab/solve_slab.h"
#include "tests/bench/bench.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

struct Cloud {
    const char* name;
    DropletDistribution droplets;
};

constexpr Cloud kClouds[] = {
    {"r_e 7 um, gamma 2", {.density = 3e8, .effective_radius = 7e-6, .gamma = 2}},
    {"r_e 12 um, gamma 8", {.density = 1e8, .effective_radius = 12e-6, .gamma = 8}},
    {"r_e 4 um, gamma 5", {.density = 5e8, .effective_radius = 4e-6, .gamma = 5}}};

/// Droplets at 550 nm without the forward peak within 5 degrees.
struct CloudPhase {
    SlabMedium medium;
    AngularTable once, twice;
};

CloudPhase make_cloud(const Cloud& cloud) {
    constexpr double kWavelength = 550e-9;
    const auto index = refractive_index(Substance::water, kWavelength);
    const auto optics = average_droplets(cloud.droplets, kWavelength, index.value(), {}, {});
    const PeakSplit split = split_peak(optics->phase, 5 * pi / 180);
    return {{table_moments(split.rest, 400), 1},
            split.rest,
            convolve_with_itself(split.rest, kConvolutionMoments, optics->phase.angle).table};
}

struct Rms {
    double squares = 0, weight = 0, largest = 0;

    void add(double error, double w = 1) {
        squares += w * error * error;
        weight += w;
        largest = std::max(largest, std::abs(error));
    }
    double value() const { return std::sqrt(squares / weight); }
};

const std::vector<double> kDegrees = {0, 30, 60, 70, 80};

std::vector<double> light_cosines() {
    std::vector<double> cosines;
    for (const double angle : kDegrees) {
        cosines.push_back(std::cos(angle * pi / 180));
    }
    return cosines;
}

/// T_1, T_2, T_3+, R_1, R_2, R_3+ and all that is transmitted.
using Shares = std::array<double, 7>;

Shares list_shares(const OrderShares& s) {
    return {s.transmitted[1],
            s.transmitted[2],
            s.transmitted[3],
            s.reflected[1],
            s.reflected[2],
            s.reflected[3],
            s.transmitted[0] + s.transmitted[1] + s.transmitted[2] + s.transmitted[3]};
}

Shares true_shares(const SlabSolution& slab, std::size_t i) {
    const auto& o = slab.order;
    const double t = slab.total.transmittance[i], r = slab.total.reflectance[i];
    const double t1 = o[1].transmittance[i], t2 = o[2].transmittance[i];
    const double r1 = o[1].reflectance[i], r2 = o[2].reflectance[i];
    return {t1, t2, t - o[0].transmittance[i] - t1 - t2, r1, r2, r - r1 - r2, t};
}

void print_shares(const Cloud& cloud) {
    // Between the depths that models are fitted at and that the table has rows for.
    constexpr double kDepths[] = {0.06, 0.15, 0.3, 0.55, 0.9, 1.4, 2, 2.9, 4, 5.5, 8.5, 13, 20, 40};
    const CloudPhase phase = make_cloud(cloud);
    const SlabTable table = make_slab_table(phase.medium);
    const std::vector<double> cosines = light_cosines();
    const auto fits = fit_column_models(phase.medium, cosines, column_fit_depths());
    using Errors = std::vector<std::array<Rms, 7>>;
    Errors by_model(cosines.size()), by_table(cosines.size());
    for (const double depth : kDepths) {
        const SlabSolution slab = solve_slab(phase.medium, {depth, 0, cosines, 48, 3}).front();
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            const Shares truth = true_shares(slab, i);
            const Shares model =
                list_shares(eval_column_model(fits[i].model, depth, std::exp(-depth / cosines[i])));
            const Shares tabulated = list_shares(eval_slab_table(table, depth, cosines[i]));
            for (std::size_t q = 0; q < truth.size(); ++q) {
                by_model[i][q].add(model[q] - truth[q]);
                by_table[i][q].add(tabulated[q] - truth[q]);
            }
        }
    }
    std::printf("\n%s, g %.3f: RMS (largest) error, thousandths of the light\n\n", cloud.name,
                phase.medium.moment[1]);
    std::printf("| by | degrees | T_1 | T_2 | T_3+ | R_1 | R_2 | R_3+ | T |\n");
    std::printf("|---|---:|---:|---:|---:|---:|---:|---:|---:|\n");
    for (const auto& [name, errors] :
         {std::pair<const char*, const Errors&>{"model", by_model}, {"table", by_table}}) {
        for (std::size_t i = 0; i < cosines.size(); ++i) {
            std::printf("| %s | %.0f |", name, kDegrees[i]);
            for (const Rms& error : errors[i]) {
                std::printf(" %.1f (%.1f) |", 1e3 * error.value(), 1e3 * error.largest);
            }
            std::printf("\n");
        }
    }
}

constexpr std::size_t kViews = 16, kAzimuths = 36;

/// A direction of view.
struct View {
    std::size_t index;
    double cosine, azimuth, weight;
};

std::vector<View> list_views(const GaussLegendre& rule) {
    constexpr double kLeastCosine = 0.1;  // nearer to the horizon nothing is asked
    std::vector<View> views;
    for (std::size_t v = 0; v < kViews; ++v) {
        for (std::size_t a = 0; rule.node[v] > kLeastCosine && a < kAzimuths; ++a) {
            views.push_back(
                {v, rule.node[v], pi * (static_cast<double>(a) + 0.5) / kAzimuths, rule.weight[v]});
        }
    }
    return views;
}

void print_radiance(const Cloud& cloud) {
    const CloudPhase phase = make_cloud(cloud);
    const RadianceTable table = make_radiance_table(phase.medium);
    const GaussLegendre rule = make_gauss_legendre(kViews);
    const std::vector<View> views = list_views(rule);
    const SlabRadianceRequest request{7.3, 6, light_cosines(), rule.node, 64, 48, 2};
    const auto second = solve_slab_radiance(phase.medium, request);
    const auto shares =
        solve_slab(phase.medium, {request.optical_depth, request.halvings, request.lights, 64, 3});
    std::printf("\n%s: RMS error of the radiance over its RMS, %%, above / below the layer\n\n",
                cloud.name);
    std::printf("| depth | degrees | profile | table of 2+ |\n|---:|---:|---:|---:|\n");
    for (std::size_t j = 0; j < second.size(); ++j) {
        for (std::size_t l = 0; l < kDegrees.size(); ++l) {
            const double depth = second[j].optical_depth, light = request.lights[l];
            std::array<Rms, 2> by_profile, by_table, size;
            for (const bool below : {false, true}) {
                const Shares flux = true_shares(shares[j], l);
                const double rest = flux[below ? 2 : 5];
                const double a = below ? depth / 2 : (1 - phase.medium.moment[1]) * depth;
                for (const View& v : views) {
                    const double sines = std::sqrt((1 - light * light) * (1 - v.cosine * v.cosine));
                    const double angle = std::acos(std::clamp(
                        (below ? 1 : -1) * light * v.cosine + sines * std::cos(v.azimuth), -1.0,
                        1.0));
                    const double once =
                        eval_table(phase.once, angle) *
                        (below ? transmitted_once : reflected_once)(depth, light, v.cosine);
                    const double twice =
                        eval_table(phase.twice, angle) *
                        (below ? transmitted_twice : reflected_twice)(depth, light, v.cosine);
                    const auto& side = below ? second[j].transmitted : second[j].reflected;
                    const double more =
                        light / pi * eval_slab_radiance(second[j], side, v.index, l, v.azimuth);
                    size[below].add(once + more, v.weight);
                    by_profile[below].add(
                        twice + light * rest * spread_profile(a, v.cosine) / pi - more, v.weight);
                    by_table[below].add(
                        eval_radiance_table(table, depth, light, v.cosine, v.azimuth, below) - more,
                        v.weight);
                }
            }
            std::printf("| %.3f | %.0f |", depth, kDegrees[l]);
            for (const auto* error : {&by_profile, &by_table}) {
                std::printf(" %.1f / %.1f |", 100 * (*error)[0].value() / size[0].value(),
                            100 * (*error)[1].value() / size[1].value());
            }
            std::printf("\n");
        }
    }
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::slab_accuracy(int, char**) {
    for (const opaline::bake::Cloud& cloud : opaline::bake::kClouds) {
        opaline::bake::print_shares(cloud);
    }
    for (const opaline::bake::Cloud& cloud : opaline::bake::kClouds) {
        opaline::bake::print_radiance(cloud);
    }
    return 0;
}
