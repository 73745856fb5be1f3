#include <gtest/gtest.h>

#include "bake/reference/glossy_brdf.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

formats::Gloss metal(float roughness) {
    formats::Gloss gloss;
    gloss.metallic = 1;
    gloss.roughness = roughness;
    gloss.specular = 1;
    return gloss;
}
formats::Gloss dielectric(float roughness) {
    formats::Gloss gloss = metal(roughness);
    gloss.metallic = 0;
    return gloss;
}

bake::Moments along_normals(const ReferenceFixture& fixture, bake::PathOptions options,
                            std::uint32_t samples) {
    return mean_over(fixture.space(options),
                     bake::choose_receivers(fixture.scene, 8, 3, std::nullopt), samples);
}

/// A disc of angular radius 0.1 in the direction of 40 degrees from +Y, irradiance pi across it.
constexpr float kTilt = 0.7f;
formats::Environment small_sun() {
    formats::Environment sky;
    const float radius = 0.1f;
    const float radiance = static_cast<float>(std::numbers::pi / formats::disc_solid_angle(radius));
    sky.discs.push_back(
        {{std::sin(kTilt), std::cos(kTilt), 0}, radius, {radiance, radiance, radiance}});
    return sky;
}

std::unique_ptr<ReferenceFixture> plate(const formats::Gloss& gloss, formats::Environment sky) {
    Scene input = make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})});
    input.materials[0].gloss = gloss;
    return make_fixture(std::move(input), std::move(sky));
}

// Radiance toward the eye, by a quadrature of the BRDF over the disc.
glm::dvec3 lit_by_sun(const formats::Gloss& gloss, glm::vec3 to_eye) {
    bake::OpaqueSurface surface;
    surface.metallic = gloss.metallic;
    surface.roughness = gloss.roughness;
    surface.f0 = glm::vec3(0.04f);
    surface.f90 = 1;
    const auto brdf = bake::make_glossy_brdf(surface, glm::vec3(0, 1, 0), to_eye);
    const auto sun = small_sun().discs[0];
    const glm::vec3 axis(sun.direction.x, sun.direction.y, sun.direction.z);
    const bake::Frame frame = bake::make_frame(axis);
    glm::dvec3 sum(0);
    constexpr int kSteps = 200;
    const double drop = 1 - std::cos(double{sun.angular_radius});
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j < kSteps; ++j) {
            const double c = 1 - drop * (i + 0.5) / kSteps, s = std::sqrt(1 - c * c);
            const double phi = 2 * std::numbers::pi * (j + 0.5) / kSteps;
            const glm::vec3 d = frame.to_world(glm::vec3(s * std::cos(phi), s * std::sin(phi), c));
            const double cosine = double{d.y};
            sum += glm::dvec3(bake::eval_mirrored(brdf, d).response) +
                   glm::dvec3(brdf.diffuse_albedo) * cosine / std::numbers::pi;
        }
    }
    return sum * std::numbers::pi / double{kSteps * kSteps};
}

// The light is sampled as well as the lobe: both strategies' weights add up.
TEST(ReferenceGlossPaths, SunOnAPlateMatchesTheBrdf) {
    for (const float roughness : {0.1f, 0.6f}) {
        for (const formats::Gloss& gloss : {metal(roughness), dielectric(roughness)}) {
            const auto lit = plate(gloss, small_sun());
            // Near the mirror direction of the sun, and along the normal.
            for (const glm::vec3 to_eye :
                 {glm::normalize(glm::vec3(-0.75f, 1, 0.1f)), glm::vec3(0, 1, 0)}) {
                auto chosen = bake::choose_receivers(lit->scene, 4, 3, std::nullopt);
                for (bake::ReferenceReceiver& r : chosen) {
                    r.to_eye = to_eye;
                }
                const bake::Moments all = mean_over(lit->space(), chosen, 40000);
                const double expected = lit_by_sun(gloss, to_eye).y;
                EXPECT_NEAR(all.mean.y, expected, 4 * standard_error(all) + 1e-3 * expected)
                    << roughness << " metallic " << gloss.metallic << " eye " << to_eye.x;
                EXPECT_LT(standard_error(all), 0.02 * expected);
            }
        }
    }
}

TEST(ReferenceGlossPaths, LobesAreTermsOfTheirOwnAndAddUp) {
    const auto lit = plate(dielectric(0.4f), make_white_sky());
    const bake::GlossyBrdf brdf = bake::make_glossy_brdf(
        {glm::vec3(1), 0, 0.4f, glm::vec3(0.04f), 1}, glm::vec3(0, 1, 0), glm::vec3(0, 1, 0));
    bake::PathOptions diffuse, specular, across, no_mirror;
    diffuse.terms = formats::TermSet::diffuse;
    specular.terms = formats::TermSet::specular;
    across.terms = formats::TermSet::interreflection | formats::TermSet::single |
                   formats::TermSet::multiple | formats::TermSet::unscattered;
    no_mirror.own_mirror = false;
    EXPECT_NEAR(along_normals(*lit, diffuse, 50000).mean.x, brdf.diffuse_albedo.x, 4e-3);
    EXPECT_NEAR(along_normals(*lit, specular, 50000).mean.x, brdf.mirrored_albedo.x, 4e-3);
    EXPECT_NEAR(along_normals(*lit, no_mirror, 50000).mean.x, brdf.diffuse_albedo.x, 4e-3);
    EXPECT_EQ(along_normals(*lit, across, 500).mean.x, 0);
    EXPECT_NEAR(along_normals(*lit, {}, 50000).mean.x, 1, 5e-3);
}

TEST(ReferenceGlossPaths, LightByWayOfTwoSurfacesIsInterreflection) {
    // White metal plates that face each other: half of the light comes by way of the other one,
    // and all of it comes.
    Scene input = make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}),
                              make_quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2})});
    input.materials[0].gloss = metal(0.5f);
    const auto plates = make_fixture(std::move(input), make_white_sky());
    bake::PathOptions once, often;
    once.terms = formats::TermSet::specular;
    often.terms = formats::TermSet::interreflection;
    const bake::Moments first = along_normals(*plates, once, 20000);
    const bake::Moments second = along_normals(*plates, often, 20000);
    EXPECT_GT(second.mean.x, 0.1);
    EXPECT_NEAR(first.mean.x + second.mean.x, 1, 0.01);
}

TEST(ReferenceGlossPaths, ImagesOfRoughnessAndMetallicAreLookedUp) {
    // Left half a mirror-like black metal, right half diffuse: base colour 0.5, no specular.
    Scene input = make_scene({make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})});
    input.primitives[0].texcoord.resize(input.primitives[0].position.size());
    for (std::size_t i = 0; i < input.primitives[0].position.size(); ++i) {
        input.primitives[0].texcoord[i] = {input.primitives[0].position[i].x < 0 ? 0.25f : 0.75f,
                                           0.5f};
    }
    input.images.push_back({2, 1, {0, 51, 255, 255, 0, 255, 0, 255}});
    input.materials[0].base_color = {0.5f, 0.5f, 0.5f};
    input.materials[0].gloss = metal(0.8f);
    input.materials[0].gloss.specular = 0;
    input.materials[0].gloss.image = 0;
    const formats::Scene& scene = input;
    for (std::uint32_t v = 0; v < scene.primitives[0].position.size(); ++v) {
        const auto surface = bake::opaque_surface_at_vertex(scene, 0, v);
        const bool left = scene.primitives[0].position[v].x < 0;
        EXPECT_NEAR(surface.roughness, left ? 0.8f * 0.2f : 0.8f, 1e-6f);
        EXPECT_NEAR(surface.metallic, left ? 1 : 0, 1e-6f);
        EXPECT_EQ(surface.is_diffuse(), !left);
    }
}

TEST(ReferenceGlossPaths, WithNeitherMetalNorSpecularPathsAreThoseOfADiffuseSurface) {
    formats::Gloss rough;
    rough.roughness = 0.2f;  // says nothing without a lobe
    const auto plain = plate({}, make_half_sky(true)), same = plate(rough, make_half_sky(true));
    EXPECT_EQ(along_normals(*plain, {}, 100).mean, along_normals(*same, {}, 100).mean);
}

}  // namespace
}  // namespace opaline::tests
