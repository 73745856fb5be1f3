// Convex bodies alone: what is not traced, and that tracing would find the same.
#include <gtest/gtest.h>

#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using tests::largest_difference;
using tests::make_scene;
using tests::make_sphere;
using tests::small_bake;

BakeResult bake_convex(const formats::Scene& scene, bool forced,
                       BakeOptions options = small_bake()) {
    if (forced) simulate_all_but_bounces(options);
    return tests::bake_scene(scene, options);
}

std::uint64_t rays_of(const BakeResult& result, std::string_view stage = "") {
    std::uint64_t rays = 0;
    for (const StageReport& s : result.stages) {
        rays += s.name.starts_with(stage) ? s.rays : 0;
    }
    return rays;
}

const PlanEntry& visibility_of(const BakeResult& result) {
    return *find_entry(result.plan, "light.visibility", 0);
}

// Codes of 8 bits and sums in another order.
constexpr double kRounding = 1e-3;

TEST(ConvexBodies, AnOpaqueOnePaysForItsIrradianceAlone) {
    BakeOptions fine;
    fine.quality = Quality::reference;
    fine.cubemap_size = 32;
    const BakeResult result = bake_convex(make_scene({make_sphere(3, 0.05f)}), false, fine);
    EXPECT_EQ(rays_of(result), 0u);
    EXPECT_FALSE(tests::has_stage(result, "hierarchy"));
    EXPECT_TRUE(result.asset.openness.empty());
    EXPECT_FALSE(visibility_of(result).on);
    for (const formats::Rgb c : tests::relight(result.asset.view(), "white")) {
        ASSERT_NEAR(c.r, 1, 1e-3);
        ASSERT_EQ(c.r, c.g);
    }
}

TEST(ConvexBodies, RaysForcedOnFindWhatWasNotTraced) {
    const formats::Primitive ball = make_sphere(3);
    // Coordinates are rounded, and normals lean out of their facets by up to .9 degrees.
    formats::Primitive box =
        tests::transformed(tests::make_cube(6, false), tests::some_rotation(), 0.3f, {2, -1, 4});
    const glm::mat3 lean(glm::rotate(glm::mat4(1), 0.015f, glm::vec3(0.6f, 0, 0.8f)));
    for (glm::vec3& n : box.normal) {
        n = lean * n;
    }
    for (const formats::Primitive& body : {ball, box}) {
        const auto scene = make_scene({body});
        const BakeResult open = bake_convex(scene, false), traced = bake_convex(scene, true);
        ASSERT_FALSE(visibility_of(open).on) << visibility_of(open).reason;
        EXPECT_TRUE(visibility_of(traced).forced);
        EXPECT_EQ(rays_of(open), 0u);
        EXPECT_GT(rays_of(traced, "rows of "), 1000u);
        EXPECT_LT(visibility_of(open).bound, 1.0 / 512);
        EXPECT_LE(largest_difference(open.asset, traced.asset, "white"),
                  visibility_of(open).bound + 1e-6);
    }
}

// A dent of one vertex: its neighbours rise above its horizon.
formats::Scene dented(float depth) {
    formats::Primitive ball = make_sphere(3);
    ball.position[0] *= 1 - depth;
    return make_scene({ball});
}

TEST(ConvexBodies, ADentIsTracedAsSoonAsItCouldShadeMoreThanTheBound) {
    // A vertex of the icosahedron lies .0095 above its neighbours' plane, .138 from them.
    const BakeResult shallow = bake_convex(dented(0.012f), false),
                     forced = bake_convex(dented(0.012f), true);
    EXPECT_FALSE(visibility_of(shallow).on) << visibility_of(shallow).bound;
    EXPECT_GT(visibility_of(shallow).bound, 1e-6) << "deeper than its neighbours";
    EXPECT_LE(largest_difference(shallow.asset, forced.asset, "white"),
              visibility_of(shallow).bound + 1e-6);
    const BakeResult deep = bake_convex(dented(0.025f), false);
    EXPECT_TRUE(visibility_of(deep).on);
    EXPECT_FALSE(visibility_of(deep).forced);
    EXPECT_GT(rays_of(deep, "rows of "), 1000u);
}

formats::Medium milky() {
    formats::Medium medium;
    medium.sigma_s = {90, 60, 40};
    medium.sigma_a = {1, 2, 3};
    return medium;
}

BakeOptions multiple_and_specular() {
    return tests::only({"multiple", "specular"});
}

TEST(ConvexBodies, LightEntersAMediumUntraced) {
    const auto scene = tests::make_translucent_scene({make_sphere(4)}, milky());
    const BakeResult open = bake_convex(scene, false, multiple_and_specular());
    const BakeResult traced = bake_convex(scene, true, multiple_and_specular());
    ASSERT_FALSE(visibility_of(open).on) << visibility_of(open).bound;
    EXPECT_EQ(rays_of(open, "samples of "), 0u);
    EXPECT_EQ(rays_of(open, "openness"), 0u);
    EXPECT_GT(rays_of(traced, "samples of "), 1000u);
    EXPECT_GT(rays_of(traced, "openness"), 1000u);
    for (const formats::Openness& o : open.asset.openness) {
        EXPECT_EQ(o.fraction, 255);
    }
    EXPECT_LE(largest_difference(open.asset, traced.asset, "white"),
              visibility_of(open).bound + kRounding);
}

TEST(ConvexBodies, FacetsThatShadeTheirOwnNormalsAreTraced) {
    const auto scene = tests::make_translucent_scene({make_sphere(2)}, milky());
    const BakeResult coarse = bake_convex(scene, false, multiple_and_specular());
    EXPECT_TRUE(visibility_of(coarse).on);
    EXPECT_GT(rays_of(coarse, "samples of "), 1000u);
}

TEST(ConvexBodies, EachMaterialIsAskedByItself) {
    // A floor under the open sky, and below it two balls that see each other and the floor.
    auto scene = make_scene({tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 4),
                             make_sphere(2, 1, {-1.5f, -3, 0}), make_sphere(2, 1, {1.5f, -3, 0})});
    scene.materials.push_back({.name = "Ball"});
    scene.primitives[1].material = scene.primitives[2].material = 1;
    const BakeResult result = bake_convex(scene, false);
    EXPECT_FALSE(find_entry(result.plan, "light.visibility", 0)->on);
    EXPECT_TRUE(find_entry(result.plan, "light.visibility", 1)->on);
    EXPECT_TRUE(tests::has_stage(result, "rows of 'quad'"));
    EXPECT_EQ(rays_of(result, "rows of 'quad'"), 0u);
    EXPECT_GT(rays_of(result, "rows of 'sphere'"), 1000u);
}

}  // namespace
}  // namespace opaline::bake
