#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "bake/physics/slab/low_orders.h"
#include "bake/physics/slab/solve_radiance.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/texture.h"
#include "tests/runtime/clouds/lit_layer.h"

// An even layer is a plane slab: what is seen of it is known from the solvers of bake/physics/slab.

namespace opaline::runtime {
namespace {

using formats::Clouds;
using formats::Rgb;
using formats::Vec3;

const Vec3 kBelow{100, 0, 200}, kAbove{100, 5000, 200};
constexpr std::array<std::uint8_t, 4> kBlack{0, 0, 0, 255};

// 100 m, kappa_S H near 2.5 to 4.4 by band, over black ground.
const Clouds& black_based() {
    static const Clouds clouds = [] {
        test::TestLayer layer = test::even_test_layer();
        layer.radiance = {20, 16, 8};
        return test::make_test_clouds(
            layer, [](std::uint32_t, std::uint32_t) { return 1e9; }, kBlack);
    }();
    return clouds;
}

double rest_depth(const formats::LayerRecord& record, std::size_t band) {
    return static_cast<double>(record.band[band].rest_kappa() * record.highest);
}

// A slab under a sun of irradiance 1: single scattering by its closed form, more by adding and
// doubling.
struct SolvedSlab {
    double depth = 0, light = 1;
    std::vector<double> view;
    bake::PeakSplit split;
    bake::SlabRadiance more;

    double radiance(std::size_t v, double azimuth, double angle, bool transmitted) const {
        const double factor = bake::eval_slab_radiance(
            more, transmitted ? more.transmitted : more.reflected, v, 0, azimuth);
        const double once = transmitted ? bake::transmitted_once(depth, light, view[v])
                                        : bake::reflected_once(depth, light, view[v]);
        return light / std::numbers::pi * factor + once * bake::eval_table(split.rest, angle);
    }
};

SolvedSlab solve(const formats::LayerRecord& record, double light, std::vector<double> view) {
    SolvedSlab slab{rest_depth(record, 1), light, std::move(view), {}, {}};
    slab.split = bake::split_peak(test::test_phase({}), static_cast<double>(record.peak_angle));
    bake::SlabRadianceRequest request;
    request.optical_depth = slab.depth;
    request.lights = {light};
    request.view = slab.view;
    request.streams = 20;
    request.modes = 16;
    request.first_order = 2;
    const bake::SlabMedium medium{bake::table_moments(slab.split.rest, 400), 1.0};
    slab.more = bake::solve_slab_radiance(medium, request).front();
    return slab;
}

TEST(EvenLayer, IsTheSlabFromBelowAndAbove) {
    for (const double sun : {0.9, 0.25}) {
        const test::LitLayer lit(black_based(), test::one_sun(sun));
        const SolvedSlab slab = solve(lit.light.record, sun, {1, 0.7, 0.3, 0.95, 0.5, 0.2});
        for (std::size_t v = 0; v < slab.view.size(); ++v) {
            for (const double azimuth : {0.4, 1.7, 3.0}) {
                const bool up = v < 3;
                const Vec3 ray = test::direction_of(up ? slab.view[v] : -slab.view[v], azimuth);
                const SeenLayer seen = see_layer(lit.light, {up ? kBelow : kAbove, ray});
                // Light and view travel against the directions of sun and ray.
                const double angle =
                    std::acos(static_cast<double>(dot(lit.light.sun.front().direction, ray)));
                const double expected = slab.radiance(v, azimuth, angle, up);
                // The table is linear between nodes and has eight modes.
                EXPECT_NEAR(static_cast<double>(seen.radiance.g), expected, 0.03 * expected + 5e-4)
                    << sun << " " << slab.view[v] << " " << azimuth;
            }
        }
    }
}

TEST(EvenLayer, LeavesOfWhatLiesBehindTheExponential) {
    const test::LitLayer lit(black_based(), test::one_sun(0.7));
    for (const double sine : {1.0, 0.6, 0.2}) {
        const SeenLayer seen = see_layer(lit.light, {kBelow, test::direction_of(sine, 0.3)});
        for (const auto& [value, sun, band] :
             {std::tuple(seen.transmittance.r, seen.sun_transmittance.r, std::size_t{0}),
              std::tuple(seen.transmittance.b, seen.sun_transmittance.b, std::size_t{2})}) {
            const double depth = rest_depth(lit.light.record, band) / sine;
            const double whole =
                depth / (1 - static_cast<double>(lit.light.record.band[band].peak_weight));
            EXPECT_NEAR(static_cast<double>(value) / std::exp(-depth), 1, 2e-4);
            EXPECT_NEAR(static_cast<double>(sun) / std::exp(-whole), 1, 2e-4);
        }
    }
}

TEST(EvenLayer, IsInvisibleInAWhiteFurnace) {
    test::TestLayer layer = test::even_test_layer();
    layer.record.haze = 1e-4f;
    const test::LitLayer lit(
        test::make_test_clouds(layer, [](std::uint32_t, std::uint32_t) { return 1e9; },
                               {255, 255, 255, 255}),
        test::white_sky());
    for (const Vec3 eye : {kBelow, kAbove, Vec3{0, 1040, 0}}) {
        for (const double sine : {1.0, 0.5, 0.1, 0.01, -0.01, -0.1, -0.5, -1.0}) {
            const Rgb color = see_through_layer(lit.scene(), {eye, test::direction_of(sine, 0.3)});
            EXPECT_NEAR(color.r, 1, 0.01) << eye.y << " " << sine;
            EXPECT_NEAR(color.b, 1, 0.01) << eye.y << " " << sine;
        }
    }
}

TEST(EvenLayer, OverGroundIsTheClosedFormOfRadiosity) {
    // E_G = S / (1 - rho Rbar), S all that comes down through the layer.
    const float albedo = linear_from_srgb(124);
    const test::LitLayer lit(test::make_test_clouds(test::even_test_layer()), test::one_sun(0.6));
    const std::array<float, 3> depth = rest_depths(lit.light, lit.light.record.highest);
    const FluxShares flux = flux_shares(lit.light.tables[1], lit.light.record, depth[1], 0.6f);
    const float mean = mean_transmittance(lit.light.tables[1], depth[1]);
    const float down = 0.6f * (flux.straight + flux.across);
    const float ground = down / (1 - albedo * (1 - mean));
    const Rgb seen = see_ground(lit.light, 500, -300, 0);
    EXPECT_NEAR(seen.g / (albedo / std::numbers::pi_v<float> * ground), 1, 2e-3f);
}

TEST(EvenLayer, WithoutRadiosityTheGroundHasWhatComesDownOnce) {
    formats::Clouds clouds = test::make_test_clouds(test::even_test_layer());
    clouds.records[0].flags &= ~formats::LayerRecord::kRadiosity;
    const test::LitLayer lit(std::move(clouds), test::one_sun(0.6));
    const std::array<float, 3> depth = rest_depths(lit.light, lit.light.record.highest);
    const FluxShares flux = flux_shares(lit.light.tables[1], lit.light.record, depth[1], 0.6f);
    const float down = 0.6f * (flux.straight + flux.across);
    const Rgb seen = see_ground(lit.light, 500, -300, 0);
    EXPECT_NEAR(seen.g / (linear_from_srgb(124) / std::numbers::pi_v<float> * down), 1, 2e-3f);
    EXPECT_EQ(lit.light.base_light.at(500, -300), Rgb{});
}

// Koschmieder: e^(-haze d) of what is far off is left, the rest is the radiance near the horizon.
TEST(EvenLayer, HazeTakesWhatIsFarOffTowardTheHorizon) {
    constexpr float kHaze = 2e-4f;
    const formats::Clouds made = test::make_test_clouds(test::even_test_layer());
    const auto look = [&made](float haze, double sine, double sky) {
        formats::Clouds clouds = made;
        clouds.records[0].haze = haze;
        const test::LitLayer lit(std::move(clouds), test::sunny_day(static_cast<float>(sky), 0.6));
        const LayerRay ray{kBelow, test::direction_of(sine, 2)};
        const LayerMarch march = march_layer(lit.light.field, ray, lit.light.rest_kappa[1]);
        return std::tuple(see_layer(lit.light, ray), march.distance, lit.light.sky.horizon.g);
    };
    for (const double sine : {1.0, 0.2}) {
        for (const double sky : {0.0, 0.5}) {
            const auto [clear, distance, horizon] = look(0, sine, sky);
            const auto [hazy, same_distance, same_horizon] = look(kHaze, sine, sky);
            ASSERT_EQ(distance, same_distance);
            const float left = std::exp(-kHaze * static_cast<float>(distance));
            ASSERT_LT(left, 0.85f);
            EXPECT_NEAR(
                hazy.radiance.g,
                left * clear.radiance.g + (1 - left) * (1 - clear.transmittance.g) * horizon,
                1e-5f);
            EXPECT_EQ(hazy.transmittance, clear.transmittance);
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
