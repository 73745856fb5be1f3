// Scenes far from the world's origin and scenes of large extent: positions, clearances and rays use
// one frame.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "bake/lab/example/scene_parts.h"
#include "bake/lab/example/write_gltf.h"
#include "bake/reference/reference_receivers.h"
#include "formats/gltf/import_gltf.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"
#include "tests/support/temporary_folder.h"

namespace opaline::bake {
namespace {

// A knot 25 cm high, moved by its node [m].
formats::Scene make_moved_knot(double x, double z) {
    GltfObject knot;
    knot.name = knot.material = "Knot";
    knot.mesh = make_knot({.height = 250, .along = 96, .around = 12});
    for (glm::dvec3& p : knot.mesh.position) {
        p *= 1e-3;
    }
    const tests::TemporaryFolder folder;
    const auto files = write_gltf(folder.path(), "knot", {knot});
    EXPECT_TRUE(files);
    nlohmann::json document = nlohmann::json::parse(std::ifstream(folder / "knot.gltf"));
    document["nodes"][0]["translation"] = {x, 0, z};
    std::ofstream(folder / "knot.gltf") << document;
    auto imported = formats::import_gltf(folder / "knot.gltf", {});
    EXPECT_TRUE(imported);
    return std::move(imported->scene);
}

TEST(FarScenes, KnotsRelightAsAtTheOrigin) {
    const formats::Medium medium = tests::make_grey_medium(200, 2);
    const auto relit = [&](double x, bool translucent) {
        formats::Scene scene = make_moved_knot(x, -x);
        if (translucent) scene.materials[scene.primitives[0].material].medium = medium;
        BakeOptions options = tests::small_bake();
        leave_bounces_out(options);
        return tests::relight(tests::bake_scene(scene, options).asset.view(), "studio");
    };
    for (const bool translucent : {false, true}) {
        const auto at_origin = relit(0, translucent);
        // Floats round to 1 and to 8 mm there.
        const double metres = translucent ? 10000 : 100000;
        EXPECT_LT(tests::relative_rms(relit(metres, translucent), at_origin), 1e-3) << translucent;
    }
}

TEST(FarScenes, FilesHoldWorldPositions) {
    const formats::Scene scene = make_moved_knot(1000, -1000);
    EXPECT_GT(glm::length(scene.origin), 1000);
    const BakeResult baked = tests::bake_scene(scene, tests::small_bake());
    const formats::Scene here = make_moved_knot(0, 0);
    EXPECT_EQ(here.origin, glm::dvec3(0));
    for (std::size_t v = 0; v < baked.asset.position.size(); v += 100) {
        const glm::vec3 p = here.primitives[0].position[v];
        EXPECT_NEAR(baked.asset.position[v].x, p.x + 1000, 1e-4f);
        EXPECT_NEAR(baked.asset.position[v].y, p.y, 1e-6f);
        EXPECT_NEAR(baked.asset.position[v].z, p.z - 1000, 1e-4f);
    }
}

// A small triangle 10 m away, of material 1.
formats::Primitive make_distant_triangle() {
    formats::Primitive p = tests::make_quad({10, 0, 0}, {0, 0, 1e-3f}, {1e-3f, 0, 0});
    p.index.resize(3);
    p.material = 1;
    return p;
}

TEST(FarScenes, WhatIsSmallAndAtTheOriginKeepsItsLightInALargeScene) {
    const formats::Primitive sheet =
        tests::make_quad({-0.025f, 0, -0.025f}, {0, 0, 0.05f}, {0.05f, 0, 0}, 20);
    auto scene = tests::make_scene({sheet});
    scene.materials.push_back({.name = "Other"});
    const BakeResult alone = tests::bake_scene(scene, tests::small_bake());
    scene.primitives.push_back(make_distant_triangle());
    BakeOptions options = tests::small_bake();
    simulate_all_but_bounces(options);  // rays even where nothing can be met
    const BakeResult large = tests::bake_scene(scene, options);
    const auto a = tests::relight_primitive(alone.asset, "white");
    const auto b = tests::relight_primitive(large.asset, "white");
    for (std::size_t v = 0; v < a.size(); ++v) {
        ASSERT_NEAR(b[v].g, a[v].g, 1e-4f) << v;
    }
}

TEST(FarScenes, WhatIsTranslucentAndAtTheOriginKeepsItsLightInALargeScene) {
    auto scene = tests::make_translucent_scene(tests::make_sheet(0.002f, 8, 0.05f),
                                               tests::make_grey_medium(500, 50));
    BakeOptions options = tests::small_bake();
    simulate_all_but_bounces(options);
    const BakeResult alone = tests::bake_scene(scene, options);
    scene.primitives.push_back(make_distant_triangle());
    const BakeResult large = tests::bake_scene(scene, options);
    EXPECT_LT(tests::relative_rms(tests::relight_primitive(large.asset, "white"),
                                  tests::relight_primitive(alone.asset, "white")),
              1e-3);
}

// Mean single scattering of the reference at the vertices of a ball centred at x [m] in the frame.
// Its radius is 20 mean free paths.
struct SingleOfBall {
    double mean = 0, variance = 0;
};
SingleOfBall single_of_ball(float x) {
    constexpr float kFreePath = 0.5e-3f;
    const auto fixture = tests::make_fixture(
        tests::make_translucent_scene({tests::make_sphere(2, 20 * kFreePath, {x, 0, 0})},
                                      tests::make_grey_medium(0.8f / kFreePath, 0.2f / kFreePath)),
        tests::make_white_sky());
    PathOptions paths;
    paths.terms = formats::TermSet::single;
    EstimateOptions wanted;
    wanted.samples = 8192;
    const auto receivers = choose_receivers(fixture->scene, 100, 0, std::nullopt);
    const auto estimate = estimate_receivers(fixture->space(paths), receivers, wanted, {});
    EXPECT_TRUE(estimate);
    SingleOfBall ball;
    const double n = static_cast<double>(estimate->pixel.size());
    for (const Moments& m : estimate->pixel) {
        ball.mean += m.mean.y / n;
        ball.variance += m.variance_of_mean().y / (n * n);
    }
    return ball;
}

TEST(FarScenes, TheReferenceFindsTheSameSingleScatteringWhereverABallLies) {
    const SingleOfBall here = single_of_ball(0);
    ASSERT_GT(here.mean, 0.05);
    EXPECT_LT(std::sqrt(here.variance), 0.005 * here.mean);
    for (const float x : {10.0f, 30.0f}) {
        const SingleOfBall there = single_of_ball(x);
        EXPECT_NEAR(there.mean, here.mean, 3 * std::sqrt(here.variance + there.variance)) << x;
    }
}

// Eyes are in world space.
TEST(FarScenes, TheReferenceSeesTheSamePictureFromAnEyeThatMovesWithTheScene) {
    const auto look = [](double x) {
        auto scene = tests::make_dented_ball();
        scene.origin = {x, 0, 0};
        const auto fixture = tests::make_fixture(std::move(scene), tests::make_half_sky(true));
        runtime::Camera camera;
        const auto at = static_cast<float>(x);
        camera.eye = {at, 2, 6};
        camera.target = {at, 1, 0};
        camera.width = 16;
        camera.height = 12;
        EstimateOptions wanted;
        wanted.samples = 16;
        return estimate_image(fixture->space(), camera, wanted, {})->mean.pixel;
    };
    const auto here = look(0), there = look(4096);
    double sum = 0;
    for (std::size_t i = 0; i < here.size(); ++i) {
        EXPECT_EQ(here[i], there[i]) << i;
        sum += static_cast<double>(here[i].g);
    }
    EXPECT_GT(sum, 10);
}

}  // namespace
}  // namespace opaline::bake
