// Whole bakes of volumes that send out light by themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "runtime/volumes/volume_march.h"
#include "tests/support/lamps_beside_paths.h"
#include "tests/support/media_bake.h"
#include "tests/support/volumes.h"

namespace opaline::tests {
namespace {

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
