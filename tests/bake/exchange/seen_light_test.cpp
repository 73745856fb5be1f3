#include "bake/exchange/seen_light.h"

#include <gtest/gtest.h>

#include <numbers>

#include "formats/opal/cubemap.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

// What is seen of a place under an even sky of radiance 1.
double see(const SeenLight& seen, const MetPlace& met, std::uint32_t n) {
    std::vector<float> row(seen.bands * formats::cubemap_texels(n));
    add_seen(seen, met, {1, 1, 1}, 0, seen.bands, row);
    const std::vector<double> solid_angles = formats::texel_solid_angles(n);
    double sum = 0;
    for (std::size_t i = 0; i < formats::cubemap_texels(n); ++i) {
        sum += static_cast<double>(row[i]) * solid_angles[i % solid_angles.size()];
    }
    return sum;
}

// A floor that no receiver sees, and one who looks at it from above.
TEST(SeenLight, OnlookersSeeWhatASurfaceSendsAndNothingOfItsBack) {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, 4)});
    scene.materials[0].base_color = {0.6f, 0.4f, 0.2f};
    const tests::LitScene lit(std::move(scene));
    const std::vector<RowLayout> layouts = lit.layouts();
    const BakeInputs inputs = lit.inputs();
    const Knobs knobs;
    const Context context;
    LightInputs asked{inputs, knobs, context, layouts, {}};
    std::uint64_t rays = 0;
    EXPECT_EQ(solve_exchange(asked, place_exchange(asked, rays), {}, rays, Bounces::none), nullptr);
    std::vector<Receiver> onlookers;
    for (int i = 0; i < 64; ++i) {
        onlookers.push_back({{0, 0.5f + 0.01f * static_cast<float>(i), 0}, {0, -1, 0}});
    }
    asked.onlookers = onlookers;
    const auto light = solve_exchange(asked, place_exchange(asked, rays), {}, rays, Bounces::none);
    ASSERT_NE(light, nullptr);
    const DensitySpace space;
    for (const std::uint32_t n : {4u, 8u, 16u}) {
        const SeenLight seen = see_surfaces(*light, space, make_light_cells(n), 3, context);
        EXPECT_NEAR(see(seen, {{0.2f, 0, 0.1f}, {0, 1, 0}, 0, -1}, n), 0.6, 0.02) << n;
        EXPECT_EQ(see(seen, {{0.2f, 0, 0.1f}, {0, 1, 0}, 0, 1}, n), 0) << n;
    }
    const SeenLight grey = see_surfaces(*light, space, make_light_cells(8), 1, context);
    EXPECT_NEAR(see(grey, {{0, 0, 0}, {0, 1, 0}, 0, -1}, 8),
                0.2126 * 0.6 + 0.7152 * 0.4 + 0.0722 * 0.2, 0.02);
}

}  // namespace
}  // namespace opaline::bake
