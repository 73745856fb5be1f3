// Whole bakes of lamps that light smoke, against the path tracer.
// Whole bakes of volumes that send out light by themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "bake/check/model_pairs.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/reference/reference_receivers.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_march.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

/// Light of all lamps at vertices of the first primitive: the file beside path tracing.
inline bake::MeanSquares lamps_beside_paths(const Scene& scene, const bake::BakeResult& result) {
    const auto reference = bake::make_reference_scene(scene, 2);
    EXPECT_TRUE(reference);
    std::vector<bake::ReferenceReceiver> receivers =
        bake::choose_receivers(*reference, 60, 3, std::nullopt);
    std::erase_if(receivers, [](const auto& receiver) { return receiver.primitive != 0; });
    const formats::Environment black;
    const bake::LightSampler sky = bake::make_light_sampler(black, glm::mat3(1.0f));
    const bake::PathSpace space{*reference, sky, {.terms = formats::TermSet::emitters}};
    const formats::AssetView view = result.asset.view();
    const std::vector<formats::Rgb> lit(view.emitters.size(), formats::Rgb{1, 1, 1});
    bake::ModelCheckOptions options;
    options.max_events = 6000000;
    options.noise = 0.02;
    const auto check = bake::check_light(
        {&space, 1}, receivers,
        bake::relight_receivers(
            view, receivers,
            {.vector = make_light("black", view.cubemap_size), .emitters = {.color = lit}}),
        options, {});
    EXPECT_TRUE(check);
    return bake::sum_up(check->pairs);
}

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

formats::Volume glowing_volume() {
    formats::Volume volume = make_volume(make_blob(0.5, 0.25), 3, 0.7f, 0.3f);
    make_it_glow(volume, {4, 2, 1});
    volume.emitter = "fire";
    return volume;
}

TEST(GlowBake, AVolumeIsAnEmitterThatIsSwitchedByItsName) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes = {glowing_volume(), glowing_volume()};
    const bake::BakeResult result = bake_scene(scene, small_bake());
    const formats::AssetView view = result.asset.view();
    EXPECT_EQ(list_emitters(view.emitters), "'fire', 'fire (2)'");
    ASSERT_EQ(view.volumes.glow.record.size(), 4u) << "each volume scatters light of both";
    EXPECT_EQ(view.volumes.glow.own_of(1)->emitter, 1u);
    const auto see = [&](const std::vector<formats::Rgb>& colors) {
        const runtime::VolumeLight lit = runtime::relight_volumes(
            view.volumes, {}, {.terms = formats::TermSet::none, .emitters = {colors}});
        return runtime::march_volumes(runtime::light_volumes(view.volumes, lit),
                                      {{-4, 0.1f, 0}, {1, 0, 0}})
            .radiance.g;
    };
    const float first = see({{1, 1, 1}, {}}), second = see({{}, {1, 1, 1}});
    EXPECT_GT(first, 0);
    EXPECT_NEAR(see({{1, 1, 1}, {1, 1, 1}}), first + second, 1e-4f * first);
    EXPECT_NEAR(see({{2, 2, 2}, {}}), 2 * first, 1e-4f * first);
    EXPECT_EQ(see({{}, {}}), 0);
}

TEST(GlowBake, AFileKnowsHowFarItsLightErrs) {
    Scene scene;
    scene.materials.resize(1);
    scene.volumes = {glowing_volume()};
    const bake::BakeResult result = bake_scene(scene, small_bake());
    const auto found = std::ranges::find(result.error.by_effect, "light of volumes",
                                         &bake::ErrorReport::Part::name);
    ASSERT_NE(found, result.error.by_effect.end());
    EXPECT_GT(found->rms_relative, 0);
    EXPECT_LT(found->rms_relative, 0.06);
    // Errors of light of the sky are as without.
    Scene dark = scene;
    dark.volumes[0].emission = {};
    const bake::BakeResult plain = bake_scene(dark, small_bake());
    EXPECT_EQ(plain.volume_error->rms_relative, result.volume_error->rms_relative);
    EXPECT_EQ(plain.asset.volumes.rows.code8, result.asset.volumes.rows.code8);
    EXPECT_TRUE(plain.asset.emitters.name_end.empty());
}

// A floor of some albedo below fire and its smoke, beside a glowing quad.
Scene fire_above_a_floor() {
    Scene scene = make_scene({make_quad({-3, -1.5f, -3}, {0, 0, 6}, {6, 0, 0}, 12),
                              make_quad({2, -1, -0.5f}, {0, 0, 1}, {0, 1, 0})});
    scene.materials.resize(2);
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    scene.materials[1].emission = {0.1f, 0.1f, 0.1f};
    scene.primitives[1].material = 1;
    scene.primitives[1].node = 1;
    scene.primitives[1].name = "node 'Panel' > mesh 1";
    scene.volumes = {glowing_volume()};
    return scene;
}

TEST(GlowBake, FireLightsSurfacesAsTheReferenceSaysAndIsSwitchedByItsName) {
    const Scene scene = fire_above_a_floor();
    const bake::BakeResult result = bake_scene(scene, small_bake());
    const formats::AssetView view = result.asset.view();
    EXPECT_EQ(list_emitters(view.emitters), "'Panel', 'fire'");
    EXPECT_EQ(view.volumes.glow.own_of(0)->emitter, 1u);
    const auto floor = [&](const std::vector<formats::Rgb>& colors) {
        std::vector<formats::Rgb> radiance(result.asset.position.size());
        runtime::ShadeOptions options;
        options.emitters = {colors};
        runtime::shade(view, make_light("black", view.cubemap_size), radiance, options);
        return radiance;
    };
    const auto fire = floor({{}, {1, 1, 1}}), both = floor({{1, 1, 1}, {1, 1, 1}}),
               panel = floor({{1, 1, 1}, {}}), dark = floor({{}, {}});
    constexpr std::size_t kMiddle = 6 * 13 + 6;
    EXPECT_GT(fire[kMiddle].r, 3 * fire[kMiddle].b) << "it is red";
    EXPECT_NEAR(both[kMiddle].g, fire[kMiddle].g + panel[kMiddle].g, 1e-3f * both[kMiddle].g);
    EXPECT_EQ(dark[kMiddle].g, 0);

    const bake::MeanSquares sum = lamps_beside_paths(scene, result);
    EXPECT_LT(sum.noise(), 0.05);
    // Nodes of the smoke and what bounces between floor and smoke: as the file says of itself.
    EXPECT_LT(sum.rms_relative(), 0.08);
    EXPECT_LT(std::abs(sum.bias()), 0.05);
    const auto stated =
        std::ranges::find(result.error.by_effect, "emitters", &bake::ErrorReport::Part::name);
    ASSERT_NE(stated, result.error.by_effect.end());
    EXPECT_NEAR(stated->rms_relative, sum.rms_relative(), 0.03);
}

}  // namespace

}  // namespace opaline::tests
