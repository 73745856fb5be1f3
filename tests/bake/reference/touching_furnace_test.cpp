// Bodies that touch, overlap and contain each other, without absorption, under an even sky.

#include <gtest/gtest.h>

#include "bake/scene/media_order.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/touching_bodies.h"

namespace opaline::tests {
namespace {

// Of some receivers along their normals; paths that no closed body loses.
bake::Estimate see_furnace(const Scene& scene) {
    const auto fixture = make_fixture(scene, make_white_sky());
    bake::EstimateOptions options;
    options.samples = 32;
    return bake::estimate_receivers(fixture->space(),
                                    bake::choose_receivers(fixture->scene, 200, 1, std::nullopt),
                                    options, {})
        .value();
}

TEST(TouchingFurnace, BodiesThatMeetAreAsBrightAsTheSkyAndNoPathIsLost) {
    for (BodiesThatMeet& bodies : make_bodies_that_meet()) {
        const bake::Estimate estimate = see_furnace(make_nested_scene(std::move(bodies.parts)));
        EXPECT_NEAR(merged(estimate.pixel).mean.y, 1, 1e-3) << bodies.name;
        EXPECT_LT(static_cast<double>(estimate.lost), 1e-3 * 200 * 32) << bodies.name;
    }
}

TEST(TouchingFurnace, ThreeNestedBallsAreAsBrightAsTheSky) {
    const bake::Estimate estimate =
        see_furnace(make_nested_scene({{make_sphere(2), make_grey_medium(20, 0, 1.33f)},
                                       {make_sphere(2, 0.7f), make_grey_medium(9, 0, 1.5f)},
                                       {make_sphere(2, 0.4f), make_smooth_glass(1.2f)}}));
    EXPECT_NEAR(merged(estimate.pixel).mean.y, 1, 1e-3);
}

// Of a clear body and one that absorbs, what is seen from above says which of them fills the
// overlap: the smaller one, wherever it stands in the file.
TEST(TouchingFurnace, InAnOverlapTheBodyOfLeastVolumeFillsTheSpace) {
    const Primitive large = make_box({-1, -1, -1}, {1, 1, 1}, 1),
                    small = make_box({-0.5f, 0, -0.5f}, {0.5f, 2, 0.5f}, 1);
    const formats::Medium clear = make_grey_medium(0, 0, 1), dark = make_grey_medium(0, 1, 1);
    const auto look_down_on = [&](std::vector<Part> parts) {
        const auto fixture = make_fixture(make_nested_scene(std::move(parts)), make_white_sky());
        return look(fixture->space(), {0.2f, 3, 0.1f}, {0, -1, 0}, 40000);
    };
    for (const bool is_first : {false, true}) {
        std::vector<Part> dark_is_large{{large, dark}, {small, clear}};
        std::vector<Part> dark_is_small{{large, clear}, {small, dark}};
        if (is_first) {
            std::swap(dark_is_large[0], dark_is_large[1]);
            std::swap(dark_is_small[0], dark_is_small[1]);
        }
        for (const auto& [parts, depth] : {std::pair(dark_is_large, 1), {dark_is_small, 2}}) {
            const bake::Moments seen = look_down_on(parts);
            EXPECT_NEAR(seen.mean.y, std::exp(-1.0 * depth), 4 * standard_error(seen));
        }
    }
}

TEST(MediaOrder, FallsByVolumeAndOfEqualOnesTheFirstOfTheSceneWins) {
    const formats::Medium medium = make_grey_medium(1, 0, 1);
    const Scene scene = make_nested_scene({{make_box({0, 0, 0}, {1, 1, 1}, 1), medium},
                                           {make_box({5, 5, 5}, {9, 9, 9}, 1), medium},
                                           {make_box({3, 0, 0}, {4, 1, 1}, 2), medium}});
    EXPECT_EQ(bake::order_media(scene), (std::vector<std::uint32_t>{1, 2, 0}));
}

}  // namespace
}  // namespace opaline::tests
