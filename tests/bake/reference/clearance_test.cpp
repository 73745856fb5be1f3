// Light that crossed a body unscattered and met more: a part of interreflection that paths tell
// apart.
// Bodies that touch, overlap and contain each other, without absorption, under an even sky.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bake/scene/nested_media.h"
#include "bake/trace/clearance_grid.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/bake/walks/nested_bodies.h"
#include "tests/support/touching_bodies.h"

namespace opaline::tests {
namespace {

// Of the whole scene.
bake::ClearanceGrid around(const bake::HitScene& surfaces, float cell) {
    return {surfaces.scene(), surfaces.centre(), surfaces.half_size(), cell};
}

// The bound is valid: no ray hits anything within it, for any position of triangles in the grid.
TEST(ReferenceClearance, NoRayMeetsASurfaceWithinIt) {
    const auto bodies =
        make_fixture(make_scene({make_sphere(2), make_sphere(1, 0.3f, {0.4f, 0, 0}),
                                 make_quad({-1, -0.8f, -1}, {0, 0, 2}, {2, 0.3f, 0}, 3)}),
                     make_white_sky());
    const bake::HitScene& surfaces = bodies->scene.surfaces;
    bake::RandomStream random(0, 0, 0);
    const auto next = [&] { return 2 * random.next() - 1; };
    for (const float cell : {0.013f, 0.05f, 0.2f}) {
        const bake::ClearanceGrid clearance = around(surfaces, cell);
        double known = 0, true_distance = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 point(next(), next(), next());
            float nearest = 10;
            for (int k = 0; k < 300; ++k) {
                const glm::vec3 direction = glm::normalize(glm::vec3(next(), next(), next()));
                if (const auto hit = surfaces.closest_hit({point}, direction, 10)) {
                    nearest = std::min(nearest, hit->distance);
                }
            }
            EXPECT_GE(nearest, clearance(point)) << cell;
            known += static_cast<double>(clearance(point));
            true_distance += static_cast<double>(nearest);
        }
        // The bound is not uselessly small.
        if (cell < 0.1f) {
            EXPECT_GT(known, 0.3 * true_distance) << cell;
        }
    }
}

// Each triangle spans the whole grid. Marking the cells of all would take minutes, and hours for
// 100 000 triangles.
TEST(ReferenceClearance, NothingIsKnownOfASoupOfTrianglesAsLargeAsTheScene) {
    std::vector<Primitive> sheets;
    for (int i = 0; i < 100; ++i) {
        const float lean = 0.01f * static_cast<float>(i);
        sheets.push_back(make_quad({-1, -1, -1}, {2, 0, 2 - lean}, {0, 2, lean}, 1));
    }
    const auto soup = make_fixture(make_scene(sheets), make_white_sky());
    const bake::ClearanceGrid clearance = around(soup->scene.surfaces, 0.016f);
    for (const float x : {-0.9f, -0.5f, 0.0f, 0.5f, 0.9f}) {
        EXPECT_EQ(clearance({x, 0, -x}), 0);
    }
    const bake::ClearanceGrid coarse = around(soup->scene.surfaces, 0.2f);
    EXPECT_GT(coarse({0.9f, 0, -0.9f}), 0);
}

// Skipped rays change no walk: a trivial grid gives the same numbers.
TEST(ReferenceClearance, WalksAreTheSameBitByBit) {
    Scene input = make_scene({make_sphere(3)});
    input.materials[0].medium = make_medium(30, 0.98f, 0.3f, 1.4f);
    const auto body = make_fixture(std::move(input), make_half_sky(true));
    ASSERT_GT(body->scene.clearance({0, 0, 0}), 0.5f);
    const auto trace = [&] {
        std::vector<float> found;
        for (std::uint32_t i = 0; i < 5000; ++i) {
            bake::RandomStream random(1, 0, i);
            found.push_back(
                bake::trace_ray(body->space(), {0.1f, 2, 0.2f}, {0, -1, 0}, random).radiance.x);
        }
        return found;
    };
    const auto with = trace();
    body->scene.clearance = {};
    EXPECT_EQ(trace(), with);
}

using bake::CrossedLight;
using bake::TermSet;

// A slab of the medium, practically without an end, above a floor of albedo 1/2.
Scene slab_above_floor(const formats::Medium& medium) {
    Scene scene = make_slab(medium, 1);
    Primitive floor = make_quad({-300, -0.6f, -300}, {0, 0, 600}, {600, 0, 0});
    floor.material = 1;
    scene.primitives.push_back(floor);
    scene.materials.push_back({.name = "Floor"});
    scene.materials[1].base_color = {0.5f, 0.5f, 0.5f};
    return scene;
}

// Straight down on the slab under white light.
bake::Moments look_at_slab(const ReferenceFixture& fixture, TermSet terms, CrossedLight crossed,
                           std::uint32_t samples) {
    bake::PathOptions options;
    options.terms = terms;
    options.crossed = crossed;
    return look_down(fixture.space(options), 0.5f, 1, samples);
}

// Every path crosses the slab, straight: the radiance is the floor's, 1/2.
TEST(CrossedLight, IsAllThatAClearSlabShowsOfItsFloor) {
    const auto clear =
        make_fixture(slab_above_floor(make_medium(1e-6f, 0, 0, 1)), make_white_sky());
    const TermSet more = TermSet::interreflection;
    EXPECT_NEAR(look_at_slab(*clear, more, CrossedLight::alone, 4096).mean.y, 0.5, 0.01);
    EXPECT_EQ(look_at_slab(*clear, more, CrossedLight::left_out, 4096).mean.y, 0);
    EXPECT_EQ(look_at_slab(*clear, TermSet::all & ~more, CrossedLight::alone, 4096).mean.y, 0);
}

// Both parts are there, and they add up.
TEST(CrossedLight, AndTheOtherAddUpToInterreflection) {
    const auto slab =
        make_fixture(slab_above_floor(make_medium(1, 0.9f, 0, 1.3f)), make_white_sky());
    constexpr std::uint32_t kSamples = 1 << 17;
    const bake::Moments all =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::counted, kSamples);
    const bake::Moments alone =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::alone, kSamples);
    const bake::Moments other =
        look_at_slab(*slab, TermSet::interreflection, CrossedLight::left_out, kSamples);
    EXPECT_GT(alone.mean.y, 0.02);
    EXPECT_GT(other.mean.y, 0.02);
    EXPECT_NEAR(alone.mean.y + other.mean.y, all.mean.y,
                4 * std::sqrt(alone.variance_of_mean().x + other.variance_of_mean().x +
                              all.variance_of_mean().x));
}

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
