#include "bake/plan/surface_albedo.h"

#include <gtest/gtest.h>

#include "bake/exchange/scatterers.h"
#include "tests/bake/exchange/bounce_support.h"

namespace opaline::bake {
namespace {

SurfacePoint middle_of(const formats::Scene& scene) {
    return make_surface_point(scene, {0, 0}, {0.25f, 0.25f, 0.5f});
}

TEST(SurfaceAlbedo, ColoursOfMaterialVerticesAndImageMultiply) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    formats::Primitive& p = scene.primitives[0];
    p.color.assign(p.position.size(), {0.5f, 1, 1});
    p.texcoord.assign(p.position.size(), {0.5f, 0.5f});
    scene.images.push_back({.width = 1, .height = 1, .rgba = {255, 255, 0, 255}});
    scene.materials[0].base_color_image = 0;
    const formats::Rgb c = eval_surface_albedo(scene, {}, middle_of(scene)).sum();
    EXPECT_NEAR(c.r, 0.25, 1e-4);
    EXPECT_NEAR(c.g, 0.5, 1e-4);
    EXPECT_NEAR(c.b, 0, 1e-4);
}

// Schlick's Fresnel term over cosine-weighted directions: F0 + (1 - F0) / 21.
TEST(SurfaceAlbedo, ASmoothMetalSendsTheMeanOfItsFresnelTerm) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].gloss.metallic = 1;
    scene.materials[0].gloss.roughness = 0;
    const formats::Rgb color = scene.materials[0].base_color;
    const formats::Rgb sent = eval_surface_albedo(scene, layout, middle_of(scene)).sum();
    EXPECT_NEAR(sent.g, color.g + (1 - color.g) / 21, 0.005);
    EXPECT_NEAR(sent.r, color.r + (1 - color.r) / 21, 0.005);
}

TEST(SurfaceAlbedo, AWhiteMetalOfAnyRoughnessSendsAllLight) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].base_color = {1, 1, 1};
    scene.materials[0].gloss.metallic = 1;
    for (const float roughness : {0.1f, 0.5f, 1.0f}) {
        scene.materials[0].gloss.roughness = roughness;
        EXPECT_NEAR(eval_surface_albedo(scene, layout, middle_of(scene)).sum().g, 1, 0.01)
            << roughness;
    }
}

TEST(SurfaceAlbedo, ADielectricSendsItsDiffuseLobeAndWhatItMirrors) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].base_color = {0, 0, 0};
    scene.materials[0].gloss = {.specular = 1};
    scene.materials[0].gloss.roughness = 0;
    const float mirrored = eval_surface_albedo(scene, layout, middle_of(scene)).sum().g;
    EXPECT_NEAR(mirrored, 0.04 + 0.96 / 21, 0.005);
    scene.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    const float all = eval_surface_albedo(scene, layout, middle_of(scene)).sum().g;
    EXPECT_GT(all, mirrored + 0.4f);
    EXPECT_LT(all, mirrored + 0.5f);
}

}  // namespace
}  // namespace opaline::bake
