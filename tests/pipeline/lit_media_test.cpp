// Light of emitters through media, against the sky, a furnace and path tracing.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/scene/lobe_record.h"
#include "formats/opal/emitters.h"
#include "tests/support/bake.h"

namespace opaline::bake {
namespace {

using formats::Rgb;

formats::Material wax(Rgb sigma_s, Rgb sigma_a, float eta) {
    formats::Material material{.name = "Wax"};
    material.medium.emplace();
    material.medium->sigma_s = sigma_s;
    material.medium->sigma_a = sigma_a;
    material.medium->eta = eta;
    return material;
}

// A ball of radius 0.5 in a cube of edge 2 whose inside glows.
formats::Scene ball_in_a_cube(const formats::Material& ball, float albedo, Rgb emission) {
    formats::Scene scene =
        tests::make_scene({tests::make_sphere(2, 0.5f), tests::make_cube(2, true)});
    scene.materials[0] = ball;
    scene.materials.push_back({.name = "Walls", .base_color = {albedo, albedo, albedo}});
    scene.materials[1].emission = emission;
    scene.primitives[1].material = 1;
    scene.primitives[1].node = 1;
    return scene;
}

BakeOptions options_of(MultipleModel model) {
    BakeOptions options;
    options.quality = Quality::draft;
    options.threads = 1;
    options.effects = {"direct", "multiple", "single", "emitters"};
    options.set(kMultipleModel, static_cast<double>(model));
    options.set(kEmitterParticles, 5000);
    options.set(kSamples, 2000);
    options.set(kWalks, 30000);
    options.set(kSites, 1000);
    return options;
}

std::vector<Rgb> show(const BakeResult& baked, const char* light, bool lamps) {
    std::vector<Rgb> radiance(baked.asset.position.size());
    runtime::ShadeOptions options;
    options.emitters = lamps ? runtime::EmitterLight{} : runtime::dark_emitters();
    runtime::shade(baked.asset.view(), tests::make_light(light, baked.knobs.cubemap_size), radiance,
                   options);
    return radiance;
}

double error_of(const BakeResult& baked, const char* name) {
    const auto part =
        std::ranges::find(baked.error.by_effect, std::string(name), &MeasuredError::Part::name);
    return part == baked.error.by_effect.end() ? HUGE_VAL : part->rms_relative;
}

class LitMedia : public testing::TestWithParam<MultipleModel> {};

// Walls of radiance 1 are a white sky: the same answer to the same light, by another way.
TEST_P(LitMedia, GlowingWallsAreAWhiteSky) {
    const formats::Material material = wax({20, 16, 12}, {0.1f, 0.2f, 0.4f}, 1.3f);
    const formats::Scene alone = [&] {
        formats::Scene scene = tests::make_scene({tests::make_sphere(2, 0.5f)});
        scene.materials[0] = material;
        return scene;
    }();
    const auto sky = show(tests::bake_scene(alone, options_of(GetParam())), "white", false);
    const BakeResult lit =
        tests::bake_scene(ball_in_a_cube(material, 0, {1, 1, 1}), options_of(GetParam()));
    const auto walls = show(lit, "black", true);
    double difference = 0, all = 0;
    for (std::size_t v = 0; v < sky.size(); ++v) {
        ASSERT_GT(sky[v].r, sky[v].b);
        for (const auto& [a, b] : {std::pair(sky[v].r, walls[v].r), std::pair(sky[v].g, walls[v].g),
                                   std::pair(sky[v].b, walls[v].b)}) {
            difference += std::pow(a - b, 2);
            all += a * a;
        }
    }
    EXPECT_LT(std::sqrt(difference / all), 0.05);
    // Dimmed and coloured without another bake.
    std::vector<Rgb> red(walls.size());
    const std::vector<Rgb> colors{{0.5f, 0, 0}};
    runtime::ShadeOptions shading;
    shading.emitters = {colors};
    runtime::shade(lit.asset.view(), tests::make_light("black", lit.knobs.cubemap_size), red,
                   shading);
    EXPECT_NEAR(red[7].r, 0.5f * walls[7].r, 1e-4f);
    EXPECT_EQ(red[7].g, 0);
}

INSTANTIATE_TEST_SUITE_P(Models, LitMedia,
                         testing::Values(MultipleModel::dipole, MultipleModel::walks),
                         [](const auto& model) {
                             return std::string(model.param == MultipleModel::walks ? "Walks"
                                                                                    : "Dipole");
                         });

enum class Inside : std::uint8_t { ball, thin_wall, metal, coat };
constexpr std::array<const char*, 4> kInside{"Ball", "ThinWall", "Metal", "Coat"};

struct Furnace {
    Inside inside{};
    float albedo = 0;  // of the walls
};

class LampFurnace : public testing::TestWithParam<Furnace> {};

// A closed room whose walls glow and reflect a of what comes, around a thing that takes nothing:
// all is as bright as the walls would be without it, 1 / (1 - a) times what they send out.
TEST_P(LampFurnace, ShowsWhatTheWallsSendOutOverWhatTheyTake) {
    formats::Material material = wax({20, 20, 20}, {0, 0, 0}, 1);
    if (GetParam().inside == Inside::thin_wall) {
        material = {.name = "Wall"};
        material.sheet = formats::Sheet{.reflect = {.6f, .6f, .6f}, .transmit = {.4f, .4f, .4f}};
    }
    double own_share = 1;  // that a view along the normal sees besides the lobe
    if (GetParam().inside == Inside::metal) {
        material = {.name = "Metal"};
        material.gloss = {.metallic = 1, .roughness = 0.3f};
        own_share = 0;
    } else if (GetParam().inside == Inside::coat) {
        material = {.name = "Coat"};
        material.gloss = {.roughness = 0.3f, .specular = 1, .ior = 2};
        own_share = double{
            formats::eval_gloss_albedo(
                formats::make_gloss_surface(make_lobe_record(material.gloss), {1, 1, 1}, 0, 0.3f),
                1)
                .diffuse};
    }
    formats::Scene scene = ball_in_a_cube(material, GetParam().albedo, {1, 1, 1});
    formats::Primitive &thing = scene.primitives[0], &walls = scene.primitives[1];
    // Of a large triangle that is partly hidden a receiver sees the share that all of it has.
    walls = tests::make_cube(6, true);
    walls.material = walls.node = 1;
    if (GetParam().inside == Inside::thin_wall) {
        thing = tests::make_quad({-0.5f, -0.5f, 0}, {1, 0, 0}, {0, 1, 0}, 4);
    }
    const std::size_t own = thing.position.size();
    BakeOptions options = options_of(MultipleModel::walks);
    options.effects.clear();
    const BakeResult baked = tests::bake_scene(scene, options);
    const auto radiance = show(baked, "black", true);
    const double expected = 1 / (1 - double{GetParam().albedo});
    std::array<double, 2> mean{};
    double square = 0;
    for (std::size_t v = 0; v < radiance.size(); ++v) {
        if (v < own && own_share == 0) continue;
        const double off = double{radiance[v].g} / (v < own ? own_share : 1) / expected - 1;
        mean[v < own ? 0 : 1] += off / static_cast<double>(v < own ? own : radiance.size() - own);
        square += off * off / static_cast<double>(radiance.size());
    }
    const double media = error_of(baked, "emitters in media");
    const double stated = std::max(error_of(baked, "emitters"), media < 1 ? media : 0);
    std::printf("inside %+.3f, walls %+.3f, RMS %.3f, stated %.3f\n", mean[0], mean[1],
                std::sqrt(square), stated);
    // Known to a third at so few receivers.
    EXPECT_LT(std::sqrt(square), 1.3 * stated);
    EXPECT_LT(std::abs(mean[0]), 0.03);
    // Particles leave out what facets of metal reflect more than once.
    EXPECT_LT(std::abs(mean[1]), GetParam().inside == Inside::metal ? 0.03 : 0.02);
    EXPECT_LT(stated, 0.06);
}

INSTANTIATE_TEST_SUITE_P(Things, LampFurnace,
                         testing::Values(Furnace{Inside::ball, 0.8f},
                                         Furnace{Inside::thin_wall, 0.8f},
                                         Furnace{Inside::metal, 0.8f}, Furnace{Inside::coat, 0.8f}),
                         [](const auto& furnace) {
                             return std::string(
                                 kInside[static_cast<std::size_t>(furnace.param.inside)]);
                         });

// Clusters, caustics and paths see the same room with a block of brass and a ball of glass.
TEST(LitMediaReference, LightBesideMetalAndGlassIsThatOfPathTracing) {
    formats::Primitive block = tests::make_cube(1, false),
                       lamp = tests::make_quad({-0.5f, -0.5f, 0.98f}, {0, 1, 0}, {1, 0, 0});
    for (glm::vec3& position : block.position)
        position = 0.35f * position + glm::vec3(0.4f, 0.3f, -0.64f);
    lamp.name = "node 'Lamp' > mesh 1";
    formats::Scene scene = tests::make_scene({tests::make_cube(6, true), lamp, block,
                                              tests::make_sphere(3, 0.35f, {-0.5f, -0.4f, -0.6f})});
    scene.materials.resize(4);
    for (std::uint32_t p = 0; p < 4; ++p) {
        scene.primitives[p].material = scene.primitives[p].node = p;
    }
    scene.materials[0].base_color = {0.6f, 0.6f, 0.6f};
    scene.materials[1].base_color = {0, 0, 0};
    scene.materials[1].emission = {1, 1, 1};
    scene.materials[2].base_color = {0.9f, 0.7f, 0.4f};
    scene.materials[2].gloss.metallic = 1;
    scene.materials[2].gloss.roughness = 0.3f;
    formats::Medium& glass = scene.materials[3].medium.emplace();
    glass.sigma_s = glass.sigma_a = {0, 0, 0};
    glass.eta = 1.5f;
    glass.roughness = 0.2f;
    BakeOptions options = options_of(MultipleModel::walks);
    options.effects.clear();
    EXPECT_LT(error_of(tests::bake_scene(scene, options), "emitters"), 0.08);
}

// A lamp in a hollow ball, so thick that hardly any light crosses it unscattered: the outside
// glows, and path tracing agrees.
TEST(LitMediaReference, LampInAHollowBallGlowsOutside) {
    formats::Primitive inner = tests::make_sphere(2, 0.35f);
    for (std::size_t i = 0; i + 2 < inner.index.size(); i += 3) {
        std::swap(inner.index[i], inner.index[i + 1]);
    }
    for (glm::vec3& n : inner.normal) {
        n = -n;
    }
    formats::Scene scene =
        tests::make_scene({tests::make_sphere(2, 0.5f), inner, tests::make_sphere(1, 0.15f),
                           tests::make_quad({-2, -0.6f, 2}, {4, 0, 0}, {0, 0, -4}, 6)});
    scene.materials[0] = wax({40, 36, 32}, {0.2f, 0.4f, 1}, 1.3f);
    scene.materials.push_back({.name = "Bulb", .base_color = {0.5f, 0.5f, 0.5f}});
    scene.materials[1].emission = {10, 8, 5};
    scene.materials.push_back({.name = "Floor", .base_color = {0.5f, 0.5f, 0.5f}});
    scene.primitives[2].material = 1;
    scene.primitives[3].material = 2;
    for (std::uint32_t p = 0; p < 4; ++p) {
        scene.primitives[p].node = p;
    }
    scene.primitives[2].name = "node 'Bulb' > mesh 2";
    BakeOptions options = options_of(MultipleModel::walks);
    options.effects.clear();
    const BakeResult baked = tests::bake_scene(scene, options);
    const auto radiance = show(baked, "black", true);
    EXPECT_GT(radiance[0].r, 0.05f);
    EXPECT_GT(radiance[0].r, radiance[0].b);
    // What leaves the ball lights the floor, most of all beneath it.
    const std::size_t floor = radiance.size() - 49;
    EXPECT_GT(radiance[floor + 24].r, 0.01f);
    EXPECT_GT(radiance[floor + 24].r, 2 * radiance[floor].r);
    EXPECT_LT(error_of(baked, "emitters in media"), 0.18);
    for (const formats::Diagnostic& warning : baked.warnings) {
        EXPECT_EQ(warning.fault.find("does not reach"), std::string::npos) << warning.fault;
    }
}

}  // namespace
}  // namespace opaline::bake
