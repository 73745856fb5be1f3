#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "bake/check/error_warnings.h"
#include "bake/effects/effects.h"
#include "bake/reference/estimate.h"
#include "bake/reference/reference_receivers.h"
#include "formats/opal/write_opal.h"
#include "runtime/specular.h"
#include "tests/bake/reference/reference_support.h"
#include "tests/support/bake.h"
#include "tests/support/effects.h"

namespace opaline::bake {
namespace {

formats::Gloss metal(float roughness) {
    formats::Gloss gloss;
    gloss.metallic = 1;
    gloss.roughness = roughness;
    return gloss;
}

formats::Gloss dielectric(float roughness) {
    formats::Gloss gloss;
    gloss.specular = 1;
    gloss.roughness = roughness;
    return gloss;
}

formats::Scene glossy_ball(const formats::Gloss& gloss, formats::Rgb color = {1, 1, 1}) {
    formats::Scene scene = tests::make_scene({tests::make_sphere(3)});
    scene.materials[0].base_color = color;
    scene.materials[0].gloss = gloss;
    return scene;
}

BakeOptions small() {
    BakeOptions options;
    options.cubemap_size = 16;
    options.coefficients = kAllCoefficients;
    options.threads = 2;
    return options;
}

std::vector<formats::Rgb> shade_under(const formats::Asset& asset,
                                      const formats::Environment& environment,
                                      std::optional<formats::Vec3> eye) {
    const formats::AssetView view = asset.view();
    const runtime::SpecularLight mirrored =
        runtime::make_specular_light(environment, runtime::specular_needs(view), {}, 2);
    runtime::ShadeOptions options;
    options.specular = &mirrored;
    options.eye = eye;
    std::vector<formats::Rgb> radiance(view.receivers());
    runtime::shade(view, runtime::project_environment(environment, view.cubemap_size), radiance,
                   options);
    return radiance;
}

TEST(Gloss, WhiteBallsReturnWhiteLightWhole) {
    const auto white = make_environment("white").value();
    for (const formats::Gloss& gloss :
         {metal(0.3f), metal(1), dielectric(0.3f), dielectric(0.8f)}) {
        const BakeResult baked = tests::bake_scene(glossy_ball(gloss), small());
        for (const formats::Rgb& color : shade_under(baked.asset, white, std::nullopt)) {
            EXPECT_NEAR(color.g, 1, 0.01) << gloss.metallic << " " << gloss.roughness;
        }
    }
}

// A metal has no diffuse row: no ray is traced for one, and it is not grey plaster.
TEST(Gloss, MetalIsMirroredLightAloneAndKeepsItsColour) {
    const formats::Rgb gold{1.0f, 0.77f, 0.34f};
    const BakeResult baked = tests::bake_scene(glossy_ball(metal(0.4f), gold), small());
    EXPECT_FALSE(find_entry(baked.plan, "direct", 0)->on);
    EXPECT_TRUE(find_entry(baked.plan, "gloss", 0)->on);
    EXPECT_EQ(baked.error.not_measured, std::vector<std::string>{"gloss"});
    ASSERT_EQ(baked.asset.gloss.size(), 1u);
    EXPECT_EQ(baked.asset.gloss[0].metallic, 1);
    EXPECT_EQ(baked.asset.openness.size(), baked.asset.position.size());
    for (const formats::Rgb& color :
         shade_under(baked.asset, make_environment("white").value(), std::nullopt)) {
        EXPECT_GT(color.r, color.g);
        EXPECT_GT(color.g, 1.5f * color.b);
    }
}

TEST(Gloss, DiffuseSurfacesHaveNoneAndItIsLeftOutOnRequest) {
    const BakeResult plain = tests::bake_scene(glossy_ball({}), small());
    EXPECT_EQ(find_entry(plain.plan, "gloss", 0), nullptr);
    EXPECT_TRUE(plain.error.not_measured.empty());
    EXPECT_TRUE(plain.asset.gloss.empty());
    EXPECT_TRUE(plain.asset.openness.empty());
    BakeOptions options = small();
    options.effects = {"direct"};
    const BakeResult without = tests::bake_scene(glossy_ball(dielectric(0.3f)), options);
    EXPECT_FALSE(find_entry(without.plan, "gloss", 0)->on);
    EXPECT_TRUE(without.asset.gloss.empty());
}

// What is left out below its bound changes no vertex under `white` by more than the bound.
TEST(Gloss, LeftOutBelowItsBoundChangesLessThanTheBound) {
    formats::Gloss faint = dielectric(0.5f);
    faint.specular = 1e-3f;
    const auto white = make_environment("white").value();
    BakeOptions forced = small();
    simulate_all_but_bounces(forced);
    const BakeResult chosen = tests::bake_scene(glossy_ball(faint), small());
    const BakeResult all = tests::bake_scene(glossy_ball(faint), forced);
    const PlanEntry& entry = *find_entry(chosen.plan, "gloss", 0);
    ASSERT_FALSE(entry.on) << entry.bound;
    ASSERT_TRUE(find_entry(all.plan, "gloss", 0)->forced);
    const auto a = shade_under(chosen.asset, white, std::nullopt);
    const auto b = shade_under(all.asset, white, std::nullopt);
    for (std::size_t v = 0; v < a.size(); ++v) {
        EXPECT_NEAR(a[v].g, b[v].g, entry.bound + 1e-3) << "codes of 8 bits";
    }
}

// The whole way from material to radiance against path tracing with the same BRDF, seen from one
// eye, by a ball whose vertices are everywhere between head on and grazing.
TEST(Gloss, BallsUnderAStudioAgreeWithPathTracing) {
    const formats::Vec3 eye{4, 1, 3};
    const auto studio = make_environment("studio").value();
    for (const formats::Gloss& gloss : {metal(0.3f), metal(0.6f), dielectric(0.4f)}) {
        const formats::Scene scene = glossy_ball(gloss, {0.9f, 0.6f, 0.3f});
        BakeOptions options = small();
        options.cubemap_size = 32;
        const BakeResult baked = tests::bake_scene(scene, options);
        const auto radiance = shade_under(baked.asset, studio, eye);
        const auto fixture = tests::make_fixture(scene, studio);
        auto receivers = choose_receivers(fixture->scene, 150, 0, glm::vec3(eye.x, eye.y, eye.z));
        std::erase_if(receivers, [](const ReferenceReceiver& r) {
            constexpr float kGrazing = 0.15f;  // the eye does not see more of the ball
            return glm::dot(r.normal, r.to_eye) < kGrazing;
        });
        ASSERT_GT(receivers.size(), 30u);
        EstimateOptions wanted;
        wanted.samples = 6000;
        const auto truth = estimate_receivers(fixture->space(), receivers, wanted, {});
        ASSERT_TRUE(truth);
        double error = 0, noise = 0, reference = 0;
        for (std::size_t i = 0; i < receivers.size(); ++i) {
            const double mean = static_cast<double>(truth->pixel[i].mean.y);
            const double found = static_cast<double>(radiance[receivers[i].vertex].g);
            const double variance = static_cast<double>(truth->pixel[i].variance_of_mean().y);
            error += (found - mean) * (found - mean) - variance;
            noise += variance;
            reference += mean * mean;
        }
        EXPECT_LT(std::sqrt(noise / reference), 0.03) << "too few samples to tell";
        EXPECT_LT(std::sqrt(std::max(0.0, error) / reference), 0.02)
            << gloss.metallic << " " << gloss.roughness;
    }
}

// The underside of a metal ball over a wide floor of albedo 0.8 sees nothing but floor, of radiance
// 0.8 under even light but for the ball's own shadow.
TEST(Gloss, MetalMirrorsTheFloorBelowIt) {
    formats::Scene scene = glossy_ball(metal(0.2f), {0.9f, 0.9f, 0.9f});
    scene.primitives.push_back(tests::make_quad({-60, -4, 60}, {120, 0, 0}, {0, 0, -120}, 24));
    scene.primitives[1].material = 1;
    scene.materials.push_back({.name = "Floor", .base_color = {0.8f, 0.8f, 0.8f}});
    const BakeResult baked = tests::bake_scene(scene, small());
    const std::vector<formats::Rgb> seen =
        shade_under(baked.asset, make_environment("white").value(), formats::Vec3{0, -3.5f, 0});
    int below = 0;
    for (std::size_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        if (scene.primitives[0].position[v].y > -0.9f) continue;
        ++below;
        EXPECT_NEAR(seen[v].g, 0.9f * 0.8f, 0.09f) << v;
    }
    EXPECT_GT(below, 3);
}

}  // namespace
}  // namespace opaline::bake
