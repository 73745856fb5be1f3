#include <gtest/gtest.h>

#include <iterator>
#include <numbers>

#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/multiple_stage.h"
#include "bake/effects/single/rules_single.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/slab/even_light.h"
#include "bake/plan/medium_exitance.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/inspect_scene.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/media/presets.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/terms.h"
#include "tests/support/effects.h"
#include "tests/support/media_bake.h"

namespace opaline::bake {
namespace {

using formats::Medium;
using formats::Rgb;
using formats::Shading;
using tests::all_finite;
using tests::bake_scene;
using tests::make_ball_on_floor;
using tests::make_grey_medium;
using tests::only;
using tests::relative_rms;
using tests::relight_primitive;
using tests::small_bake;

constexpr const char* kLights[] = {"white", "studio", "sun:40,50", "sun:200,20"};

// A mean free path of a tenth of the ball's radius, red going farther than blue.
Medium wax() {
    Medium medium;
    medium.sigma_s = {8, 10, 14};
    medium.sigma_a = {0.05f, 0.2f, 0.8f};
    return medium;
}

Medium forward(float g) {
    Medium medium = wax();
    medium.phase = {formats::PhaseFunction::Type::henyey_greenstein, g, 0, {}, {}};
    return medium;
}

// The effects that the plan has on for the ball.
std::vector<std::string> effects_of_ball(const std::vector<PlanEntry>& plan) {
    std::vector<std::string> on;
    for (const PlanEntry& entry : plan) {
        const bool is_part = entry.name.find('.') != std::string::npos;
        if (entry.on && entry.subject.index == 0 && !is_part) {
            on.emplace_back(entry.name);
        }
    }
    return on;
}

using Names = std::vector<std::string>;

TEST(TranslucentPipeline, EachEffectAloneIsSimulatedAlone) {
    const auto scene = make_ball_on_floor(wax());
    runtime::ShadeOptions shown;
    for (const char* effect : {"multiple", "single", "specular"}) {
        const BakeResult result = bake_scene(scene, only({effect}));
        EXPECT_EQ(effects_of_ball(result.plan), Names{effect});
        const formats::PrimitiveRecord& ball = result.asset.primitives[0];
        EXPECT_EQ(ball.shading, Shading::translucent) << effect;
        const bool glossy = effect == std::string("specular");
        EXPECT_EQ(ball.bands, glossy ? 1u : 3u) << effect << ": rows of nothing have no colour";
        EXPECT_EQ(result.asset.openness.empty(), !glossy) << effect;
        // Without its light, gloss is black; the floor is left out in all three.
        EXPECT_EQ(tests::mean_green(relight_primitive(result.asset, "white")) > 0, !glossy)
            << effect;
        EXPECT_EQ(tests::mean_green(relight_primitive(result.asset, "white", 1)), 0) << effect;
    }
}

TEST(TranslucentPipeline, DirectAloneComparesWithADiffuseSurfaceOfTheSameAlbedo) {
    Medium medium = wax();
    const auto scene = tests::make_translucent_scene({tests::make_sphere(3)}, medium);
    BakeOptions options = only({"direct"});
    options.cubemap_size = 32;
    const BakeResult result = bake_scene(scene, options);
    EXPECT_EQ(effects_of_ball(result.plan), Names{"direct"});
    EXPECT_EQ(result.asset.primitives[0].shading, Shading::diffuse);
    EXPECT_TRUE(result.asset.openness.empty());
    const Rgb albedo = half_space_albedo(medium);
    EXPECT_GT(albedo.r, albedo.g);
    EXPECT_GT(albedo.g, albedo.b);
    EXPECT_EQ(result.asset.base_color[0].g, albedo.g);
    for (const Rgb c : relight_primitive(result.asset, "white")) {
        ASSERT_NEAR(c.g, albedo.g, 3e-3 * albedo.g);  // quadrature along the horizon
    }
}

// Rounding to codes is the only difference: nothing shows of it in sixteen bits.
TEST(TranslucentPipeline, MultipleAndSingleBakedApartAddUpToBoth) {
    for (const float g : {0.0f, 0.3f}) {
        const auto scene = make_ball_on_floor(forward(g));
        BakeOptions options = small_bake();
        options.quality = Quality::reference;
        options.set(kMultipleModel, static_cast<double>(MultipleModel::dipole));
        leave_bounces_out(options);
        const std::uint32_t terms = g > 0 ? 4 : 1;
        options.set(kPhaseTerms, terms);
        const BakeResult merged = bake_scene(scene, options);
        options.separate_terms = true;
        const BakeResult separate = bake_scene(scene, options);
        EXPECT_EQ(merged.asset.primitives[0].terms, terms);
        EXPECT_EQ(separate.asset.primitives[0].terms, terms + 1);
        for (const char* light : kLights) {
            const auto part = [&](formats::TermSet shown_terms) {
                runtime::ShadeOptions shown;
                shown.terms = shown_terms;
                return relight_primitive(separate.asset, light, 0, shown);
            };
            std::vector<Rgb> sum = part(formats::TermSet::multiple);
            const std::vector<Rgb> single = part(formats::TermSet::single);
            EXPECT_GT(tests::mean_green(sum), 0) << light;
            EXPECT_GT(tests::mean_green(single), 0) << light;
            for (std::size_t v = 0; v < sum.size(); ++v) {
                sum[v] = sum[v] + single[v];
            }
            EXPECT_LT(relative_rms(sum, relight_primitive(merged.asset, light)), 2e-4)
                << light << ' ' << g;
        }
        // And as effects of their own, whatever else is simulated but for what the boundary
        // mirrors: where the floor stands before the sky, that is the ball's own light.
        options.effects = {"multiple", "specular"};
        const BakeResult multiple = bake_scene(scene, options);
        runtime::ShadeOptions shown;
        shown.terms = formats::TermSet::multiple;
        options.effects = {"single"};
        options.separate_terms = false;
        const BakeResult single = bake_scene(scene, options);
        EXPECT_TRUE(single.asset.primitives[0].is_single_only());
        EXPECT_TRUE(runtime::check_terms(single.asset.view(), formats::TermSet::single));
        EXPECT_FALSE(runtime::check_terms(merged.asset.view(), formats::TermSet::single));
        EXPECT_LT(relative_rms(relight_primitive(multiple.asset, "studio", 0, shown),
                               relight_primitive(separate.asset, "studio", 0, shown)),
                  1e-6);
    }
}

TEST(TranslucentPipeline, PhaseFunctionWithAPreferenceTakesWholeDegrees) {
    const auto knobs_of = [](Quality quality) {
        BakeOptions options;
        options.quality = quality;
        return *resolve_knobs(options);
    };
    const Knobs draft = knobs_of(Quality::draft), production = knobs_of(Quality::production);
    EXPECT_EQ(choose_terms(wax(), production), 1u);
    for (const float g : {0.25f, -0.25f}) {
        EXPECT_EQ(choose_terms(forward(g), draft), 4u) << g;
        EXPECT_GE(choose_terms(forward(g), production), choose_terms(forward(g), draft)) << g;
    }
    EXPECT_GE(choose_terms(forward(0.8f), draft), 9u);
    BakeOptions options = small_bake();
    options.quality = Quality::draft;
    const BakeResult result = bake_scene(make_ball_on_floor(forward(0.25f)), options);
    EXPECT_EQ(result.asset.primitives[0].terms, 4u);
    EXPECT_EQ(find_entry(result.plan, "single.terms", 0)->terms, 4u);
    EXPECT_TRUE(all_finite(result.asset));
}

TEST(TranslucentPipeline, PlanFollowsTheMedium) {
    const auto on = [](const Medium& medium) {
        const auto scene = make_ball_on_floor(medium);
        const auto plan = plan_bake(scene, inspect_scene(scene), {});
        for (const PlanEntry& entry : plan) {
            EXPECT_FALSE(entry.reason.empty());
        }
        Names names = effects_of_ball(plan);
        std::erase(names, "interreflection");  // what the floor sends does not follow the medium
        return names;
    };
    const Names all{"multiple", "single", "specular"};
    const Medium ketchup = *formats::media_preset("ketchup");
    const Medium milk = *formats::media_preset("whole-milk");
    EXPECT_EQ(on(ketchup), all);
    EXPECT_EQ(on(milk), all);
    // What scatters little returns mostly what scattered once.
    EXPECT_GT(share_scattered_once(ketchup), 0.5);
    EXPECT_LT(share_scattered_once(*formats::media_preset("spectralon")), 0.2);
    Medium medium = milk;
    medium.eta = 1;
    EXPECT_EQ(on(medium), (Names{"multiple", "single"})) << "nothing is mirrored";
    medium = milk;
    medium.profile = Medium::Profile::normalized;
    EXPECT_EQ(on(medium), (Names{"multiple", "specular"})) << "single scattering is in it";
    medium = make_grey_medium(0, 100);
    EXPECT_EQ(on(medium), Names{"specular"}) << "a pure absorber";
    medium = make_grey_medium(0.1f, 1000);
    EXPECT_EQ(on(medium), Names{"specular"}) << "nearly one";
}

TEST(TranslucentPipeline, ScalingSceneAndMediumTogetherChangesNothing) {
    const auto scene = make_ball_on_floor(forward(0.3f));
    BakeOptions options = small_bake();
    options.set(kPhaseTerms, 4);
    leave_bounces_out(options);
    const BakeResult metres = bake_scene(scene, options);
    // A power of two is exact in floats but for where rays start; others round everywhere.
    for (const float scale : {1024.0f, 1e-6f, 1e6f}) {
        auto scaled = scene;
        for (formats::Primitive& p : scaled.primitives) {
            p = tests::transformed(p, glm::mat3(1), scale, glm::vec3(0));
        }
        Medium& medium = *scaled.materials[0].medium;
        medium.sigma_s = (1 / scale) * medium.sigma_s;
        medium.sigma_a = (1 / scale) * medium.sigma_a;
        const BakeResult result = bake_scene(scaled, options);
        for (const char* light : kLights) {
            EXPECT_LT(relative_rms(relight_primitive(result.asset, light),
                                   relight_primitive(metres.asset, light)),
                      scale == 1024 ? 1e-4 : 2e-3)
                << light << ' ' << scale;
        }
    }
}

// Optically thick limit: L_d -> R Ft-weighted E, for any spacing of vertices and samples.
TEST(TranslucentPipeline, OpticallyThickBodyReflectsTheLightThatEntersWhereItStands) {
    Medium medium = make_grey_medium(1e5f, 300);
    auto body = tests::make_sphere(3);
    body = tests::transformed(body, tests::some_rotation(), 1, glm::vec3(0));
    auto wall = tests::make_quad({-3, -1.5f, -3}, {0, 0, 6}, {6, 0, 0}, 2);
    wall.material = 1;
    const auto scene = tests::make_translucent_scene({body, wall}, medium);
    BakeOptions options = only({"multiple"});
    options.cubemap_size = 16;
    options.set(kSamples, 20000);
    const BakeResult result = bake_scene(scene, options);

    const double eta = 1.3f, exit = 1 - fresnel_moments(eta).external;
    const MediumProfile profile = make_medium_profile(medium);
    std::vector<float> transmittance;
    for (int i = 0; i <= 1024; ++i) {
        transmittance.push_back(static_cast<float>(fresnel_transmittance(i / 1024.0, eta)));
    }
    const double factor =
        fresnel_transmittance(1, eta) * profile.total(0) / (std::numbers::pi * exit);
    const auto rays = RayScene::build(scene, 2);
    const DirectionSet directions = make_direction_set(16);
    const std::vector<Receiver> receivers = make_vertex_receivers(scene);
    std::vector<float> dense(formats::cubemap_texels(16));
    for (const char* name : {"white", "studio", "sky:3,35"}) {
        const runtime::LightVector light = tests::make_light(name, 16);
        std::vector<Rgb> expected;
        for (std::size_t v = 0; v < body.position.size(); ++v) {
            gather_irradiance(*rays, directions, receivers[v], dense, transmittance);
            formats::haar_forward_cube(std::span<float>(dense), 16);
            Rgb sum{};
            for (std::size_t k = 0; k < dense.size(); ++k) {
                sum = sum + dense[k] * Rgb{light.rgba[4 * k], light.rgba[4 * k + 1],
                                           light.rgba[4 * k + 2]};
            }
            expected.push_back(static_cast<float>(factor) * sum);
        }
        EXPECT_LT(relative_rms(relight_primitive(result.asset, name), expected), 0.015) << name;
    }
}

TEST(TranslucentPipeline, SelfCheckNamesEffectsAndLights) {
    const ErrorReport error = bake_scene(make_ball_on_floor(wax()), small_bake()).error;
    const auto names = [](const std::vector<ErrorReport::Part>& parts) {
        Names list;
        for (const ErrorReport::Part& part : parts) {
            list.push_back(part.name);
            EXPECT_GT(part.rms_relative, 0) << part.name;
            EXPECT_LT(part.rms_relative, 0.2) << part.name;
        }
        return list;
    };
    EXPECT_EQ(names(error.at_receivers.by_effect),
              (Names{"multiple+single+transmission+interreflection", "direct+interreflection"}));
    EXPECT_EQ(names(error.at_receivers.by_light),
              (Names{"white", "sun:30,60", "sun:150,35", "sun:270,15", "studio", "sky:3,35"}));
    EXPECT_GT(error.rms_relative, 0);
}

}  // namespace
}  // namespace opaline::bake
