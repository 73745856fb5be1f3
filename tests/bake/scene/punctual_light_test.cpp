#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scene/base_color.h"
#include "bake/scene/punctual_light.h"

namespace opaline::bake {
namespace {

using formats::Light;
using formats::Rgb;

constexpr double kPi = std::numbers::pi;

Light spot(float inner, float outer) {
    Light light;
    light.type = Light::Type::spot;
    light.inner_cone = inner;
    light.outer_cone = outer;
    light.direction = {0, -1, 0};
    light.position = {0, 2, 0};
    return light;
}

TEST(PunctualLight, APointLightFallsWithTheSquareOfTheDistance) {
    Light light;
    light.intensity = {8, 4, 2};
    light.position = {0, 3, 0};
    const ArrivingLight at = light_at(light, {0, 1, 0});
    EXPECT_EQ(at.irradiance, (Rgb{2, 1, 0.5f}));
    EXPECT_EQ(at.to_light, glm::vec3(0, 1, 0));
    EXPECT_EQ(at.distance, 2.0f);
}

TEST(PunctualLight, ADirectionalLightHasItsIlluminanceEverywhere) {
    Light light;
    light.type = Light::Type::directional;
    light.direction = {0, 0, -1};
    light.intensity = {5, 6, 7};
    for (const float z : {-100.0f, 0.0f, 100.0f}) {
        const ArrivingLight at = light_at(light, {1, 2, z});
        EXPECT_EQ(at.irradiance, light.intensity);
        EXPECT_EQ(at.to_light, glm::vec3(0, 0, 1));
        EXPECT_TRUE(std::isinf(at.distance));
    }
}

TEST(PunctualLight, ASpotFallsFromItsInnerToItsOuterCone) {
    const Light light = spot(0.3f, 0.6f);
    const auto at_angle = [&](double angle) {
        // On the sphere of radius 2 about the light.
        return light_at(light, {2 * std::sin(angle), 2 - 2 * std::cos(angle), 0}).irradiance.g;
    };
    EXPECT_NEAR(at_angle(0), 0.25f, 1e-6f);
    EXPECT_NEAR(at_angle(0.29), 0.25f, 1e-6f);
    EXPECT_EQ(at_angle(0.61), 0.0f);
    EXPECT_EQ(at_angle(kPi), 0.0f);
    // The extension: the square of the share of the cosines between both.
    const double share = (std::cos(0.45) - std::cos(0.6)) / (std::cos(0.3) - std::cos(0.6));
    EXPECT_NEAR(at_angle(0.45), 0.25 * share * share, 1e-5);
}

TEST(PunctualLight, NothingArrivesBeyondItsRange) {
    Light light;
    light.range = 2;
    EXPECT_EQ(light_at(light, {2, 0, 0}).irradiance, (Rgb{0, 0, 0}));
    EXPECT_EQ(light_at(light, {3, 0, 0}).irradiance, (Rgb{0, 0, 0}));
    EXPECT_NEAR(light_at(light, {1, 0, 0}).irradiance.r, 1 - 1.0 / 16, 1e-6);
}

TEST(PunctualLight, AtTheLightItselfNothingIsInfinite) {
    Light light;
    light.intensity = {1e12f, 1e12f, 1e12f};
    EXPECT_EQ(light_at(light, {0, 0, 0}).irradiance, (Rgb{0, 0, 0}));
    EXPECT_EQ(light_at(light, {1e-30f, 0, 0}).irradiance, (Rgb{0, 0, 0}));
}

TEST(PunctualLight, FluxIsTheIntegralOfTheIntensity) {
    Light point;
    EXPECT_NEAR(flux_per_intensity(point), 4 * kPi, 1e-12);
    for (const auto& [inner, outer] :
         {std::pair{0.3f, 0.6f}, {0.0f, 0.785f}, {0.5f, 0.5001f}, {0.0f, 0.02f}}) {
        const Light light = spot(inner, outer);
        // Simpson over the polar angle of the irradiance at distance 1.
        constexpr int kSteps = 20000;
        double sum = 0;
        const double step = 1.01 * static_cast<double>(outer) / kSteps;
        for (int i = 0; i <= kSteps; ++i) {
            const double angle = i * step;
            const double weight = i == 0 || i == kSteps ? 1 : i % 2 == 1 ? 4 : 2;
            const ArrivingLight at = light_at(light, {std::sin(angle), 2 - std::cos(angle), 0});
            sum += weight * static_cast<double>(at.irradiance.g) * std::sin(angle);
        }
        const double numeric = 2 * kPi * sum * step / 3;
        EXPECT_NEAR(flux_per_intensity(light) / numeric, 1, 2e-3) << inner << " " << outer;
    }
}

/// A triangle whose material glows; with a texture, 1 on its left half and 0 on its right.
formats::Scene glowing_triangle(bool textured) {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.materials[0].emission = {10, 20, 30};
    formats::Primitive& p = scene.primitives.emplace_back();
    p.position = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    p.texcoord = {{0.25f, 0.5f}, {0.75f, 0.5f}, {0.25f, 0.5f}};
    p.index = {0, 1, 2};
    if (textured) {
        scene.materials[0].emission_image = 0;
        scene.images.push_back({2, 1, {255, 255, 255, 255, 0, 0, 0, 255}});
    }
    return scene;
}

TEST(Emission, WithoutATextureItIsTheFactor) {
    const formats::Scene scene = glowing_triangle(false);
    EXPECT_TRUE(is_emissive(scene.materials[0]));
    EXPECT_FALSE(is_emissive(formats::Material{}));
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0.2f, 0.3f, 0.5f}), (Rgb{10, 20, 30}));
}

TEST(Emission, TheTextureIsLookedUpBetweenTexelsInLinearLight) {
    const formats::Scene scene = glowing_triangle(true);
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {1, 0, 0}), (Rgb{10, 20, 30}));
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{0, 0, 0}));
    EXPECT_NEAR(emission_at(scene, 0, {0, 1, 2}, {0.5f, 0.5f, 0}).g, 10, 1e-4f);
}

TEST(Emission, WithoutCoordinatesOrPixelsTheFactorCounts) {
    formats::Scene scene = glowing_triangle(true);
    scene.images[0] = {};
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{10, 20, 30}));
    scene = glowing_triangle(true);
    scene.primitives[0].texcoord.clear();
    EXPECT_EQ(emission_at(scene, 0, {0, 1, 2}, {0, 1, 0}), (Rgb{10, 20, 30}));
}

}  // namespace

}  // namespace opaline::bake
