// Whole bakes of lamps that light smoke, against the path tracer.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bake/check/volumes/volume_error.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/support/lamps_beside_paths.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

formats::Light point_light(const char* name, glm::vec3 position, float intensity) {
    formats::Light light;
    light.name = name;
    light.position = position;
    light.intensity = {intensity, intensity, intensity};
    return light;
}

bake::BakeOptions draft() {
    bake::BakeOptions options = small_bake();
    options.quality = bake::Quality::draft;
    return options;
}

double stated_error(const bake::BakeResult& result) {
    const auto found = std::ranges::find(result.error.by_effect, "emitters in volumes",
                                         &bake::ErrorReport::Part::name);
    return found == result.error.by_effect.end() ? -1.0 : double{found->rms_relative};
}

// The file against other paths than those of its own check.
void expect_as_traced(const Scene& scene, const bake::BakeResult& result, double most) {
    bake::VolumeCheckOptions options;
    options.seed = 77;
    options.max_events = 1000000;
    const auto check = bake::check_lamps(scene, result.asset.view(), 0, options, {});
    ASSERT_TRUE(check);
    EXPECT_LT(check->rms_relative, most);
    EXPECT_LT(std::abs(check->bias), 0.1 + 2 * check->noise);
    EXPECT_GT(stated_error(result), 0);
    EXPECT_NEAR(stated_error(result), check->rms_relative, 0.15);
}

TEST(LampsInVolumes, ALampInACloudIsAsTheReferenceSays) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(make_volume(
        sample_grid(glm::dvec3(0.75), 0.125, [](glm::dvec3) { return 1.0; }), 4, 0.9f, 0));
    scene.lights.push_back(point_light("Bulb", {0.2f, 0.1f, -0.2f}, 1));
    expect_as_traced(scene, bake_scene(scene, draft()), 0.3);
}

// A blob of smoke above a grey floor.
Scene smoke_above_a_floor() {
    Scene scene = make_scene({make_quad({-3, -1.5f, -3}, {0, 0, 6}, {6, 0, 0}, 2)});
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    scene.volumes.push_back(make_volume(make_blob(0.4, 0.125), 2, 0.8f, 0.3f));
    return scene;
}

TEST(LampsInVolumes, ASpotBesideSmokeIsAsTheReferenceSays) {
    Scene scene = smoke_above_a_floor();
    scene.lights.push_back(point_light("Spot", {3, 1, 0}, 10));
    scene.lights[0].type = formats::Light::Type::spot;
    scene.lights[0].direction = glm::normalize(glm::vec3(-3, -1, 0));
    scene.lights[0].inner_cone = 0.2f;
    scene.lights[0].outer_cone = 0.3f;
    const bake::BakeResult result = bake_scene(scene, draft());
    expect_as_traced(scene, result, 0.3);
    EXPECT_TRUE(std::ranges::none_of(result.warnings, [](const auto& warning) {
        return warning.fault.find("volumes") != std::string::npos;
    }));
}

TEST(LampsInVolumes, AGlowingPanelBesideSmokeIsAsTheReferenceSays) {
    Scene scene = smoke_above_a_floor();
    scene.primitives.push_back(make_quad({2.2f, -0.5f, -0.5f}, {0, 0, 1}, {0, 1, 0}));
    scene.primitives.back().node = 1;
    scene.primitives.back().material = 1;
    scene.materials.resize(2);
    scene.materials[1].emission = {1, 1, 1};
    expect_as_traced(scene, bake_scene(scene, draft()), 0.3);
}

double stated_at_surfaces(const bake::BakeResult& result) {
    const auto found =
        std::ranges::find(result.error.by_effect, "emitters", &bake::ErrorReport::Part::name);
    return found == result.error.by_effect.end() ? -1.0 : double{found->rms_relative};
}

// int E dA over black walls is all that the lamp sends out: smoke that absorbs nothing only sends
// it elsewhere.
TEST(LampsInVolumes, AllPowerOfALampInWhiteSmokeArrivesAtTheWallsAroundIt) {
    constexpr std::uint32_t kCells = 6;
    Scene scene = make_scene({make_cube(kCells, true)});
    scene.materials[0].base_color = {0.001f, 0.001f, 0.001f};
    scene.volumes.push_back(make_volume(make_ball_grid(0.6, 0.1), 5, 1, 0));
    scene.lights.push_back(point_light("Bulb", {0.1f, 0, 0.05f}, 1));
    const bake::BakeResult result = bake_scene(scene, draft());
    const formats::AssetView view = result.asset.view();
    ASSERT_EQ(view.emitters.blocks_of(0).size(), 1u);
    double power = 0;
    for (std::size_t v = 0; v < (kCells + 1) * (kCells + 1) * 6; ++v) {
        const std::size_t i = v % (kCells + 1), j = v / (kCells + 1) % (kCells + 1);
        const double share = (i % kCells == 0 ? 0.5 : 1) * (j % kCells == 0 ? 0.5 : 1);
        const formats::Rgb row = block_value(view.emitters, view.emitters.blocks_of(0)[0], v);
        power += share * 4 / (kCells * kCells) * std::numbers::pi * double{row.g};
    }
    EXPECT_NEAR(power, 4 * std::numbers::pi, 0.06 * 4 * std::numbers::pi);
}

TEST(LampsInVolumes, SmokeInABeamLightsTheFloorAsTheReferenceSays) {
    Scene scene = smoke_above_a_floor();
    scene.lights.push_back(point_light("Spot", {3, 0, 0}, 10));
    scene.lights[0].type = formats::Light::Type::spot;
    scene.lights[0].direction = {-1, 0, 0};
    scene.lights[0].inner_cone = 0.2f;
    scene.lights[0].outer_cone = 0.3f;
    const bake::BakeResult result = bake_scene(scene, draft());
    const bake::MeanSquares floor = lamps_beside_paths(scene, result);
    EXPECT_LT(floor.noise(), 0.05);
    EXPECT_LT(floor.rms_relative(), 0.12);
    EXPECT_LT(std::abs(floor.bias()), 0.06);
    EXPECT_NEAR(stated_at_surfaces(result), floor.rms_relative(), 0.05);
}

TEST(LampsInVolumes, EachIsSwitchedByItsNameBesideFire) {
    Scene scene = smoke_above_a_floor();
    make_it_glow(scene.volumes[0], {1, 0.5f, 0.2f});
    scene.volumes[0].emitter = "fire";
    scene.lights = {point_light("Bulb", {3, 0.5f, 0}, 5), point_light("Torch", {-3, 0.5f, 0}, 2)};
    const bake::BakeResult result = bake_scene(scene, draft());
    const formats::AssetView view = result.asset.view();
    ASSERT_EQ(list_emitters(view.emitters), "'Bulb', 'Torch', 'fire'");
    ASSERT_EQ(view.volumes.glow.record.size(), 3u);
    EXPECT_EQ(view.volumes.glow.own_of(0)->emitter, 2u);
    const auto see = [&](std::vector<formats::Rgb> colors) {
        const runtime::VolumeLight lit = runtime::relight_volumes(
            view.volumes, {}, {.terms = formats::TermSet::none, .emitters = {colors}});
        return runtime::march_volumes(runtime::light_volumes(view.volumes, lit),
                                      {{-4, 0.1f, 0}, {1, 0, 0}})
            .radiance.g;
    };
    const formats::Rgb on{1, 1, 1};
    const float bulb = see({on, {}, {}}), torch = see({{}, on, {}}), fire = see({{}, {}, on});
    EXPECT_GT(bulb, 0);
    EXPECT_GT(torch, 0);
    EXPECT_GT(fire, 0);
    EXPECT_NEAR(see({on, on, on}), bulb + torch + fire, 1e-3f * (bulb + torch + fire));
}

}  // namespace
}  // namespace opaline::tests
