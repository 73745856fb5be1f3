#include "bake/physics/slab/slab_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <numbers>

#include "bake/physics/phase.h"
#include "bake/physics/slab/solve_radiance.h"
#include "tests/bake/slab/slab_support.h"

namespace opaline::tests {
namespace {

using bake::CosineSampler;
using bake::SlabWalk;
using bake::SlabWalkRequest;
using std::numbers::pi;

TEST(SlabWalkTest, SampledCosinesHaveTheMomentsOfTheirPhaseFunction) {
    std::vector<double> cosine, value;
    for (int i = 0; i <= 200; ++i) {
        cosine.push_back(-1 + i / 100.0);
        value.push_back(3 * bake::henyey_greenstein(cosine.back(), 0.4));
    }
    cosine.back() = 1;
    for (const auto& [sampler, g] : {std::pair{CosineSampler::henyey_greenstein(0.4), 0.4},
                                     {CosineSampler::henyey_greenstein(-0.9), -0.9},
                                     {CosineSampler::henyey_greenstein(5e-5), 5e-5},
                                     {CosineSampler::henyey_greenstein(0), 0.0},
                                     {CosineSampler::tabulated(cosine, value), 0.4}}) {
        double first = 0, second = 0;
        constexpr int kSamples = 100000;
        double last = -1;
        for (int i = 0; i < kSamples; ++i) {
            const double x = sampler.sample((i + 0.5) / kSamples);
            EXPECT_GE(x, last);
            last = x;
            first += x / kSamples;
            second += (1.5 * x * x - 0.5) / kSamples;
        }
        EXPECT_LE(last, 1);
        EXPECT_NEAR(first, g, 2e-4);
        EXPECT_NEAR(second, g * g, 2e-4);
    }
    const double peaked[] = {-1, 0, 0, 0.5, 1}, flat[] = {0, 0, 1, 0, 0};  // a step up, empty ends
    const CosineSampler odd = CosineSampler::tabulated(peaked, flat);
    EXPECT_GE(odd.sample(0), 0);
    EXPECT_LE(odd.sample(1 - 0x1p-53), 0.5 + 1e-7);
}

TEST(SlabWalkTest, AgreesWithAddingAndDoublingByOrder) {
    Deviations all;
    std::uint64_t seed = 0;  // cases must not share their numbers, or they deviate together
    for (const double g : {0.0, 0.75}) {
        for (const double albedo : {1.0, 0.9}) {
            for (const double depth : {0.3, 3.0}) {
                for (const double cosine : {1.0, 0.3}) {
                    const SlabWalkRequest request{depth, albedo, cosine, 40000, ++seed};
                    const SlabWalk walk =
                        walk_slab(CosineSampler::henyey_greenstein(g), request, {});
                    const auto slab =
                        solve_one(henyey_greenstein_slab(g, albedo), depth, cosine, 3, 32);
                    all.add(walk.reflectance, slab.total.reflectance[0]);
                    all.add(walk.transmittance, slab.total.transmittance[0]);
                    double reflected = slab.total.reflectance[0],
                           transmitted = slab.total.transmittance[0];
                    for (std::size_t n = 0; n < 3; ++n) {
                        all.add(walk.reflected_order[n], slab.order[n].reflectance[0]);
                        all.add(walk.transmitted_order[n], slab.order[n].transmittance[0]);
                        reflected -= slab.order[n].reflectance[0];
                        transmitted -= slab.order[n].transmittance[0];
                    }
                    all.add(walk.reflected_order[3], reflected);
                    all.add(walk.transmitted_order[3], transmitted);
                    EXPECT_EQ(walk.reflected_order[0].share, 0);
                }
            }
        }
    }
    all.expect_normal(140);
}

TEST(SlabWalkTest, DirectionsAgreeWithTheModesOfTheAzimuth) {
    constexpr unsigned kRows = 4, kColumns = 6;
    SlabWalkRequest request{2, 1, 0.34, 150000, 3};
    request.histogram_from = 2;
    request.cosine_bins = kRows;
    request.azimuth_bins = kColumns;
    const SlabWalk walk = walk_slab(CosineSampler::henyey_greenstein(0.6), request, {});
    const bake::GaussLegendre rule = bake::make_gauss_legendre(4);
    std::vector<double> views;
    for (unsigned row = 0; row < kRows; ++row) {
        for (const double node : rule.node) {
            views.push_back((row + node) / kRows);
        }
    }
    const auto radiance =
        solve_slab_radiance(henyey_greenstein_slab(0.6, 1),
                            {request.optical_depth, 0, {request.cosine}, views, 24, 10, 2})
            .front();
    // Flux through a bin: radiance times cosine over solid angle; E mu_l = 1. Both signs of phi.
    Deviations all;
    for (const bool below : {false, true}) {
        const auto& modes = below ? radiance.transmitted : radiance.reflected;
        const auto& histogram = below ? walk.transmitted_histogram : walk.reflected_histogram;
        for (unsigned row = 0; row < kRows; ++row) {
            for (unsigned column = 0; column < kColumns; ++column) {
                double share = 0;
                for (std::size_t i = 0; i < rule.node.size(); ++i) {
                    for (std::size_t j = 0; j < rule.node.size(); ++j) {
                        const double azimuth = pi * (column + rule.node[j]) / kColumns;
                        const std::size_t view = row * rule.node.size() + i;
                        share += 2 * rule.weight[i] / kRows * rule.weight[j] * pi / kColumns *
                                 views[view] / pi *
                                 eval_slab_radiance(radiance, modes, view, 0, azimuth);
                    }
                }
                all.add(histogram[row * kColumns + column], share);
            }
        }
    }
    EXPECT_EQ(all.count, 48);
    all.expect_normal(48);
}

TEST(SlabWalkTest, NothingIsLostWithoutAbsorption) {
    const SlabWalk walk =
        walk_slab(CosineSampler::henyey_greenstein(0.85), {10, 1, 0.5, 20000, 1}, {});
    EXPECT_EQ(walk.absorptance.share, 0);
    EXPECT_EQ(walk.reflectance.share + walk.transmittance.share, 1);
    // Every photon leaves with the weight 1: a binomial.
    const double p = walk.reflectance.share;
    EXPECT_NEAR(walk.reflectance.standard_error, std::sqrt(p * (1 - p) / 20000), 1e-6);
}

TEST(SlabWalkTest, RouletteKeepsTheMeanOfStrongAbsorbers) {
    const auto slab = solve_one(henyey_greenstein_slab(0.5, 0.2), 1, 0.7);
    const SlabWalk walk =
        walk_slab(CosineSampler::henyey_greenstein(0.5), {1, 0.2, 0.7, 200000, 1}, {});
    EXPECT_NEAR(walk.reflectance.share, slab.total.reflectance[0],
                4 * walk.reflectance.standard_error);
    EXPECT_NEAR(walk.absorptance.share, 1 - slab.total.reflectance[0] - slab.total.transmittance[0],
                4 * walk.absorptance.standard_error);
    const SlabWalk black =
        walk_slab(CosineSampler::henyey_greenstein(0.5), {1, 0, 1, 10000, 1}, {});
    EXPECT_EQ(black.reflectance.share, 0);
    EXPECT_NEAR(black.transmittance.share, std::exp(-1.0), 4 * black.transmittance.standard_error);
    EXPECT_EQ(
        walk_slab(CosineSampler::henyey_greenstein(0), {0, 1, 1, 10, 1}, {}).transmittance.share,
        1);
}

TEST(SlabWalkTest, BitsDependOnTheSeedAndNotOnThreads) {
    SlabWalkRequest request{2, 0.95, 0.6, 30000, 11};
    request.cosine_bins = request.azimuth_bins = 3;
    const auto run = [&](unsigned threads) {
        bake::Context context;
        context.threads = threads;
        return walk_slab(CosineSampler::henyey_greenstein(0.7), request, context);
    };
    const SlabWalk one = run(1);
    for (const unsigned threads : {2u, 5u}) {
        const SlabWalk many = run(threads);
        EXPECT_EQ(one.reflectance.share, many.reflectance.share);
        EXPECT_EQ(one.absorptance.standard_error, many.absorptance.standard_error);
        for (std::size_t i = 0; i < one.reflected_order.size(); ++i) {
            EXPECT_EQ(one.reflected_order[i].share, many.reflected_order[i].share);
            EXPECT_EQ(one.transmitted_order[i].standard_error,
                      many.transmitted_order[i].standard_error);
        }
        for (std::size_t i = 0; i < one.reflected_histogram.size(); ++i) {
            EXPECT_EQ(one.reflected_histogram[i].share, many.reflected_histogram[i].share);
        }
    }
    request.seed = 12;
    EXPECT_NE(run(1).reflectance.share, one.reflectance.share);
}

TEST(SlabWalkTest, CancelledWalksSayHowFarTheyCame) {
    const std::atomic<bool> cancel{true};
    bake::Context context;
    context.cancel = &cancel;
    const SlabWalk walk =
        walk_slab(CosineSampler::henyey_greenstein(0), {1, 1, 1, 1000000, 0}, context);
    EXPECT_EQ(walk.photons, 0u);
    EXPECT_EQ(walk.reflectance.share, 0);
}

}  // namespace
}  // namespace opaline::tests
