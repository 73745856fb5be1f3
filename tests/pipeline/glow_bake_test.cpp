// Whole bakes of volumes that send out light by themselves.
#include <gtest/gtest.h>

#include <algorithm>

#include "runtime/volumes/volume_march.h"
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

TEST(GlowBake, BesideSurfacesAWarningSaysThatTheyStayDark) {
    Scene scene = make_scene({make_quad({-1, -3, -1}, {0, 0, 2}, {2, 0, 0}, 2)});
    scene.volumes = {glowing_volume()};
    const bake::BakeResult result = bake_scene(scene, small_bake());
    EXPECT_TRUE(std::ranges::any_of(result.warnings, [](const formats::Diagnostic& warning) {
        return warning.fault.find("does not reach surfaces") != std::string::npos;
    }));
    EXPECT_EQ(list_emitters(result.asset.view().emitters), "'fire'");
}

}  // namespace
}  // namespace opaline::tests
