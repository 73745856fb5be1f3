#include "bake/effects/interreflection/surface_albedo.h"

#include <gtest/gtest.h>

#include "bake/effects/interreflection/scatterers.h"
#include "tests/bake/interreflection/bounce_support.h"

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
    const formats::Rgb c = eval_surface_albedo(scene, {}, middle_of(scene));
    EXPECT_NEAR(c.r, 0.25, 1e-4);
    EXPECT_NEAR(c.g, 0.5, 1e-4);
    EXPECT_NEAR(c.b, 0, 1e-4);
}

TEST(SurfaceAlbedo, GlossAndMetalTakeFromTheDiffuseLobe) {
    formats::Scene scene = tests::make_plates(1, 0.5f, 1);
    RowLayout layout;
    layout.mirrors = true;
    scene.materials[0].gloss.metallic = 1;
    EXPECT_NEAR(eval_surface_albedo(scene, layout, middle_of(scene)).g, 0, 1e-6);
    scene.materials[0].gloss = {.specular = 1};
    const float dielectric = eval_surface_albedo(scene, layout, middle_of(scene)).g;
    EXPECT_LT(dielectric, 0.5f);
    EXPECT_GT(dielectric, 0.4f);
}

}  // namespace
}  // namespace opaline::bake
