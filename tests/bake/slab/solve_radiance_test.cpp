#include "bake/physics/slab/solve_radiance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/physics/phase.h"
#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/radiance_table.h"
#include "tests/bake/slab/slab_support.h"

namespace opaline::tests {
namespace {

using bake::SlabRadiance;
using bake::SlabRadianceRequest;
using std::numbers::pi;

constexpr double kLights[] = {0.2, 0.7, 1.0}, kEyes[] = {0.15, 0.5, 0.9};

SlabRadianceRequest crossed_request(double depth, unsigned modes, unsigned first_order) {
    return {
        depth, 0,          {kLights[0], kLights[1], kLights[2]}, {kEyes[0], kEyes[1], kEyes[2]}, 24,
        modes, first_order};
}

double scattering_cosine(double light, double view, double azimuth, bool transmitted) {
    const double sines = std::sqrt((1 - light * light) * (1 - view * view));
    return (transmitted ? 1 : -1) * light * view + sines * std::cos(azimuth);
}

TEST(SolveRadiance, ThinLayersShowTheSingleScatteringOfTheirPhaseFunction) {
    const double depth = 1e-7;
    const auto slab =
        solve_slab_radiance(henyey_greenstein_slab(0.5, 0.8), crossed_request(depth, 30, 1))
            .front();
    for (const bool transmitted : {false, true}) {
        for (std::size_t l = 0; l < 3; ++l) {
            for (std::size_t v = 0; v < 3; ++v) {
                for (const double azimuth : {0.0, 1.0, pi}) {
                    const double p = bake::henyey_greenstein(
                        scattering_cosine(kLights[l], kEyes[v], azimuth, transmitted), 0.5);
                    const double radiance =
                        kLights[l] / pi *
                        eval_slab_radiance(slab, transmitted ? slab.transmitted : slab.reflected, v,
                                           l, azimuth);
                    EXPECT_NEAR(radiance / (0.8 * p * depth / kEyes[v]), 1, 1e-5);
                }
            }
        }
    }
}

TEST(SolveRadiance, OrdersAreTakenAwayOneByOne) {
    const auto medium = henyey_greenstein_slab(0.6, 0.9);
    const auto all = solve_slab_radiance(medium, crossed_request(1.5, 20, 1)).front();
    const auto second = solve_slab_radiance(medium, crossed_request(1.5, 20, 2)).front();
    const auto third = solve_slab_radiance(medium, crossed_request(1.5, 20, 3)).front();
    for (std::size_t l = 0; l < 3; ++l) {
        for (std::size_t v = 0; v < 3; ++v) {
            const double once = kLights[l] / pi *
                                (eval_slab_radiance(all, all.reflected, v, l, 2) -
                                 eval_slab_radiance(second, second.reflected, v, l, 2));
            const double p =
                bake::henyey_greenstein(scattering_cosine(kLights[l], kEyes[v], 2, false), 0.6);
            EXPECT_NEAR(once, 0.9 * p * bake::reflected_once(1.5, kLights[l], kEyes[v]), 2e-5);
            EXPECT_GT(eval_slab_radiance(second, second.transmitted, v, l, 2),
                      eval_slab_radiance(third, third.transmitted, v, l, 2));
        }
    }
    // Against the shares of the flux: mode 0 integrated over the views.
    SlabRadianceRequest request = crossed_request(1.5, 1, 3);
    const bake::GaussLegendre rule = bake::make_gauss_legendre(24);
    request.view = rule.node;
    const auto rest = solve_slab_radiance(medium, request).front();
    const auto slab = solve_one(medium, 1.5, kLights[1], 3, 24);
    double flux = 0;
    for (std::size_t v = 0; v < rule.node.size(); ++v) {
        flux += 2 * rule.weight[v] * rule.node[v] * rest.reflected[v * 3 + 1];
    }
    EXPECT_NEAR(
        flux,
        slab.total.reflectance[0] - slab.order[1].reflectance[0] - slab.order[2].reflectance[0],
        1e-9);
}

// Escape function of thick layers, 3/7 (1 + 2 mu) [vandeHulst1980]: they are darker at the horizon
// than a diffuse surface, which the profile of orders 3 and more is not.
TEST(SolveRadiance, ThickLayersTransmitMoreAlongTheNormal) {
    SlabRadianceRequest request{40, 0, {0.8}, {0.2, 0.6, 1.0}, 24, 1, 3};
    const auto slab = solve_slab_radiance(henyey_greenstein_slab(0.75, 1), request).front();
    const auto flux = solve_one(henyey_greenstein_slab(0.75, 1), 40, 0.8, 0, 24);
    for (std::size_t v = 0; v < 3; ++v) {
        const double profile = slab.transmitted[v] / flux.total.transmittance[0];
        EXPECT_NEAR(profile, 3.0 / 7 * (1 + 2 * request.view[v]), 0.03) << request.view[v];
        EXPECT_NEAR(bake::spread_profile(20, request.view[v]), 1, 1e-3);
    }
}

TEST(SolveRadiance, TableIsFiniteAtItsEnds) {
    const bake::RadianceTable table =
        make_radiance_table(henyey_greenstein_slab(0.7, 1), {32, 24, 6}, 16);
    for (const double depth : {0.0, 1e-300, 1e9}) {
        for (const double cosine : {0.0, 1e-9, 1.0}) {
            EXPECT_TRUE(std::isfinite(eval_radiance_table(table, depth, cosine, 0, 1, true)));
            EXPECT_TRUE(std::isfinite(eval_radiance_table(table, depth, 1, cosine, 1, false)));
        }
    }
    EXPECT_EQ(eval_radiance_table(table, 0, 0.5, 0.5, 0, false), 0);
}

}  // namespace
}  // namespace opaline::tests
