// Lamps from a scene to what a viewer shows.
#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>

#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "formats/opal/emitters.h"
#include "tests/support/bake.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

// A floor beneath a glowing quad, with a point light aside.
formats::Scene lamp_scene() {
    formats::Scene scene =
        tests::make_scene({tests::make_quad({-1, 0, 1}, {2, 0, 0}, {0, 0, -2}, 2),
                           tests::make_quad({-0.2f, 1, -0.2f}, {0.4f, 0, 0}, {0, 0, 0.4f}, 1)});
    scene.primitives[1].name = "node 'Panel' > mesh 1";
    scene.primitives[1].node = 1;
    scene.primitives[1].material = 1;
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    scene.materials.push_back({.name = "Glow"});
    scene.materials[1].emission = {10, 5, 2};
    scene.lights.push_back(
        {.name = "Spot light", .intensity = {1, 1, 1}, .position = {0.9f, 0.5f, 0}});
    return scene;
}

BakeResult bake_lamps(const formats::Scene& scene, std::vector<std::string> effects = {},
                      unsigned threads = 1) {
    BakeOptions options;
    options.quality = Quality::draft;
    options.effects = std::move(effects);
    options.threads = threads;
    options.set(kEmitterParticles, 5000);
    options.set(kSamples, 500);
    options.set(kWalks, 5000);
    options.set(kSites, 500);
    return tests::bake_scene(scene, options);
}

std::vector<Rgb> show(const BakeResult& baked, const std::vector<Rgb>& colors) {
    std::vector<Rgb> radiance(baked.asset.position.size());
    runtime::ShadeOptions options;
    options.emitters = {colors};
    runtime::shade(baked.asset.view(), tests::make_light("black", baked.knobs.cubemap_size),
                   radiance, options);
    return radiance;
}

TEST(EmitterBake, LampsAreNamedAndAddUpAndGoOut) {
    const BakeResult baked = bake_lamps(lamp_scene());
    const formats::EmittersView emitters = baked.asset.emitters.view();
    EXPECT_EQ(list_emitters(emitters), "'Panel', 'Spot light'");
    const auto panel = show(baked, {{1, 1, 1}, {}}), light = show(baked, {{}, {2, 0, 0}}),
               both = show(baked, {{1, 1, 1}, {2, 0, 0}});
    for (std::size_t i = 0; i < both.size(); ++i) {
        EXPECT_NEAR(both[i].r, panel[i].r + light[i].r, 1e-4f);
    }
    for (const Rgb& value : show(baked, std::vector<Rgb>(2))) {
        EXPECT_EQ(value, Rgb{});
    }
    // The floor's middle, vertex 4, sees the panel's square of 0.4 m at 1 m.
    EXPECT_NEAR(panel[4].r / panel[4].g, 2, 0.02);
    EXPECT_NEAR(panel[4].r, 0.5 * 10 * 0.16 / std::numbers::pi, 0.02);
    // The panel shows its own radiance, nothing of it where it is off.
    EXPECT_NEAR(panel[9].r, 10, 0.5);
    EXPECT_LT(light[9].r, 1);
    const auto by_effect = std::ranges::find(baked.error.by_effect, std::string("emitters"),
                                             &MeasuredError::Part::name);
    ASSERT_NE(by_effect, baked.error.by_effect.end());
    EXPECT_LT(by_effect->rms_relative, 0.1);
}

TEST(EmitterBake, FileOfASceneWithoutLampsIsAsItWas) {
    formats::Scene scene = lamp_scene();
    scene.lights.clear();
    scene.materials[1].emission = {0, 0, 0};
    const BakeResult dark = bake_lamps(scene), off = bake_lamps(lamp_scene(), {"direct"});
    EXPECT_TRUE(dark.asset.emitters.view().empty());
    EXPECT_TRUE(off.asset.emitters.view().empty());
    // Rows of the environment do not know of lamps.
    const BakeResult lit = bake_lamps(lamp_scene());
    EXPECT_EQ(lit.asset.transport.code8, dark.asset.transport.code8);
    EXPECT_EQ(lit.asset.transport.average_code, dark.asset.transport.average_code);
    EXPECT_FALSE(std::ranges::any_of(dark.plan, [](const PlanEntry& entry) {
        return entry.subject.kind == Subject::Kind::emitter;
    }));
}

formats::Scene lamp_and_wax() {
    formats::Scene scene = lamp_scene();
    scene.primitives.push_back(tests::make_sphere(1, 0.1f, {0, 0.3f, 0}));
    scene.primitives[2].node = 2;
    scene.primitives[2].material = 2;
    scene.materials.push_back({.name = "Wax"});
    scene.materials[2].medium.emplace();
    scene.materials[2].medium->sigma_s = {100, 100, 100};
    scene.materials[2].medium->sigma_a = {1, 1, 1};
    return scene;
}

bool has_warning(const BakeResult& baked, const char* text) {
    return std::ranges::any_of(baked.warnings, [&](const formats::Diagnostic& warning) {
        return warning.fault.find(text) != std::string::npos;
    });
}

TEST(EmitterBake, MediaAreLitWhereTheirMultipleScatteringIsSimulated) {
    const BakeResult lit = bake_lamps(lamp_and_wax());
    EXPECT_EQ(lit.asset.emitters.view().blocks_of(2).size(), 2u);
    EXPECT_FALSE(has_warning(lit, "does not reach"));
    EXPECT_FALSE(has_warning(lit, "it lies inside of"));
    const BakeResult dark = bake_lamps(lamp_and_wax(), {"direct", "single", "emitters"});
    EXPECT_TRUE(dark.asset.emitters.view().blocks_of(2).empty());
    EXPECT_TRUE(has_warning(dark, "does not reach media whose multiple scattering is left out"));
}

// Through thousands of mean free paths next to nothing comes out.
TEST(EmitterBake, LampThatNoLightComesFromOutOfItsMediumIsNamed) {
    formats::Scene scene = lamp_and_wax();
    scene.lights[0].position = {0, 0.3f, 0};
    scene.materials[2].medium->sigma_s = {1e5f, 1e5f, 1e5f};
    scene.materials[2].medium->sigma_a = {0, 0, 0};
    EXPECT_TRUE(has_warning(bake_lamps(scene), "it lies inside of a translucent medium"));
}

// All power of a lamp in the middle of a ball that absorbs nothing leaves it, alike everywhere: of
// I [cd] and the radius R its exitance is M = I / R^2. A small black thing at the distance d from
// the middle has the irradiance M (R / d)^2 on the side that faces the ball.
TEST(EmitterBake, LightOfALampInsideOfAMediumLeavesIt) {
    formats::Scene scene =
        tests::make_scene({tests::make_sphere(3),
                           tests::make_quad({-0.1f, -2, 0.1f}, {0.2f, 0, 0}, {0, 0, -0.2f}, 1)});
    scene.primitives[1].material = 1;
    scene.materials[0].medium = tests::make_grey_medium(8, 0, 1.3f);
    scene.materials.push_back({.name = "Thing"});
    scene.materials[1].base_color = {0.05f, 0.05f, 0.05f};
    scene.lights.push_back({.name = "Bulb", .intensity = {3, 2, 1}, .position = {0, 0, 0}});
    const BakeResult baked = bake_lamps(scene);
    const auto shown = show(baked, {{1, 1, 1}});
    const std::size_t ball = scene.primitives[0].position.size();
    Rgb mean{0, 0, 0};
    for (std::size_t v = 0; v < ball; ++v) {
        mean = mean + 1 / static_cast<float>(ball) * shown[v];
    }
    constexpr float kM = std::numbers::inv_pi_v<float>;  // by candela, as radiance
    EXPECT_NEAR(mean.r, 3 * kM, 0.1f * 3 * kM);
    EXPECT_NEAR(mean.g, 2 * kM, 0.1f * 2 * kM);
    EXPECT_NEAR(mean.b, kM, 0.1f * kM);
    EXPECT_NEAR(shown[ball].r, 0.05f * 3 * kM / 4, 0.1f * 0.05f * 3 * kM / 4);
}

}  // namespace
}  // namespace opaline::bake
