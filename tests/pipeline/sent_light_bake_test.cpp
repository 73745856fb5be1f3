// Light that volumes scatter to surfaces, in files.
#include <gtest/gtest.h>

#include <cmath>

#include "bake/check/check_model.h"
#include "formats/opal/cubemap.h"
#include "tests/support/media_bake.h"
#include "tests/support/sheets.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

// An opaque patch, a leaf and a body beside a place for smoke, small against it.
Scene make_small_things() {
    Primitive leaf = make_quad({1.6f, 0.2f, -0.05f}, {0, 0.1f, 0}, {0, 0, 0.1f});
    leaf.material = 1;
    Primitive body = make_sphere(1, 0.08f, {-1.7f, 0, 0});
    body.material = 2;
    Scene scene =
        make_scene({make_quad({-0.05f, -1.6f, -0.05f}, {0, 0, 0.1f}, {0.1f, 0, 0}), leaf, body});
    scene.materials.resize(3);
    scene.materials[1] = {.name = "Leaf"};
    scene.materials[1].sheet = formats::Sheet{{0.5f, 0.3f, 0.2f}, {0.2f, 0.4f, 0.1f}};
    scene.materials[2] = {.name = "Wax"};
    formats::Medium& wax = scene.materials[2].medium.emplace();
    wax.sigma_s = {200, 200, 200};
    wax.sigma_a = {2, 2, 2};
    return scene;
}

formats::Volume make_smoke(float albedo) {
    return make_volume(make_ball_grid(1, 0.25), 2, albedo, 0);
}

bake::BakeOptions smoke_bake() {
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::preview;
    return options;
}

std::vector<formats::Rgb> see_under_even_light(const Scene& scene,
                                               const bake::BakeOptions& options) {
    const bake::BakeResult result = bake_scene(scene, options);
    return relight(result.asset.view(), make_light("white", 8));
}

TEST(SentLightBake, SmokeThatAbsorbsNothingChangesNoSurfaceInEvenLight) {
    Scene scene = make_small_things();
    const auto clear = see_under_even_light(scene, smoke_bake());
    scene.volumes.push_back(make_smoke(1));
    const auto smoky = see_under_even_light(scene, smoke_bake());
    ASSERT_EQ(smoky.size(), clear.size());
    for (std::size_t i = 0; i < clear.size(); ++i) {
        EXPECT_NEAR(smoky[i].r, clear[i].r, 0.05f * clear[i].r) << i;
        EXPECT_NEAR(smoky[i].g, clear[i].g, 0.05f * clear[i].g) << i;
    }
    // It takes a tenth of the sky's light or more from what faces it.
    scene.volumes[0] = make_smoke(0);
    const auto dim = see_under_even_light(scene, smoke_bake());
    EXPECT_LT(dim[0].r, 0.9f * clear[0].r);
}

// A floor through dense smoke: what is stated is what the file errs by, but for volumes' own error.
TEST(SentLightBake, StatedErrorOfAFloorInDenseSmokeIsThatAgainstPathTracing) {
    for (const float albedo : {0.0f, 0.9f}) {
        Scene scene = make_scene({make_quad({-1, -0.3f, -1}, {0, 0, 2}, {2, 0, 0}, 8)});
        scene.volumes.push_back(make_volume(make_ball_grid(1, 0.25), 4, albedo, 0));
        bake::BakeOptions options = smoke_bake();
        options.coefficients = 24;
        const bake::BakeResult result = bake_scene(scene, options);
        bake::ModelCheckOptions effort;
        effort.receivers = 81;
        effort.max_events = 1000000;
        effort.lit_by_volumes = true;
        const auto model = bake::check_model(scene, result.asset.view(), effort, {});
        ASSERT_TRUE(model);
        const bake::MeasuredError& stated = result.error.at_receivers;
        EXPECT_GT(stated.ci95[1], model->ci95[0]) << albedo;
        EXPECT_LT(stated.ci95[0], model->ci95[1]) << albedo;
        EXPECT_GT(stated.rms_relative, 0.02) << albedo;
    }
}

TEST(SentLightBake, LeftOutItChangesNoBitOfRows) {
    Scene scene = make_small_things();
    scene.volumes.push_back(make_smoke(1));
    bake::BakeOptions options = smoke_bake();
    options.quality = bake::Quality::draft;
    options.effects = {"direct", "sheet", "multiple", "volume-single", "volume-multiple"};
    const bake::BakeResult without = bake_scene(scene, options);
    scene.volumes[0] = make_smoke(0);
    const bake::BakeResult absorbing = bake_scene(scene, options);
    EXPECT_EQ(without.asset.transport.average_code, absorbing.asset.transport.average_code);
    EXPECT_EQ(without.asset.transport.code8, absorbing.asset.transport.code8);
    EXPECT_EQ(without.asset.transport.index16, absorbing.asset.transport.index16);
    scene.volumes[0] = make_smoke(1);
    options.effects.push_back("volume-surface");
    const bake::BakeResult with = bake_scene(scene, options);
    EXPECT_NE(without.asset.transport.code8, with.asset.transport.code8);
}

// Smoke on a floor: path tracing of the scene as it is.
TEST(SentLightBake, FileAgreesWithPathTracingAndMissesLittle) {
    Scene scene = make_scene({make_quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, 8)});
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    scene.volumes.push_back(make_volume(make_ball_grid(0.9, 0.15), 3, 0.9f, 0.3f));
    const bake::BakeResult result = bake_scene(scene, smoke_bake());
    bake::ModelCheckOptions options;
    options.receivers = 48;
    options.max_events = 500000;
    const auto dimmed = bake::check_model(scene, result.asset.view(), options, {});
    options.lit_by_volumes = true;
    const auto lit = bake::check_model(scene, result.asset.view(), options, {});
    ASSERT_TRUE(dimmed && lit);
    EXPECT_GT(dimmed->missing, 0.05);
    EXPECT_LT(lit->missing, 0.25 * dimmed->missing);
    EXPECT_LT(std::abs(lit->bias), 0.03);
    EXPECT_GT(dimmed->bias, 0.05) << "the file is brighter than smoke that only dims makes it";
}

}  // namespace
}  // namespace opaline::tests
