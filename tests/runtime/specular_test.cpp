#include "runtime/specular.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "runtime/surface.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::Rgb;
using formats::TermSet;
using formats::Vec3;

constexpr std::uint32_t kAllLevels[] = {0, 8, 20, 40};

/// The plain sum over a cube map of n x n texels.
double convolve(const Environment& map, Vec3 r, double alpha, std::uint32_t n) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    const double a2 = alpha * alpha;
    double sum = 0, weight = 0;
    for (std::uint32_t j = 0; j < formats::cubemap_texels(n); ++j) {
        const Vec3 w = formats::texel_direction(n, j / (n * n), j / n % n, j % n);
        const double cosine = dot(r, w);
        if (cosine <= 0) continue;
        const double half = (1 + cosine) / 2;  // cos^2(theta / 2)
        const double d = half * (a2 - 1) + 1;
        const double lobe = cosine * a2 / (std::numbers::pi * d * d) * solid_angle[j % (n * n)];
        sum += lobe * static_cast<double>(formats::sample_radiance(map, w).g);
        weight += lobe;
    }
    return sum / weight;
}

TEST(SpecularLight, UniformLightStaysUniformAtEveryRoughness) {
    const SpecularLight light =
        prefilter_specular(tests::even_sky({1, 2, 0.5f}), kAllLevels, {}, 0);
    ASSERT_EQ(light.maps.size(), std::size(kAllLevels));
    for (const SpecularLight::Map& map : light.maps) {
        for (const Rgb c : map.radiance.pixel) {
            ASSERT_NEAR(c.r, 1, 2e-6);
            ASSERT_NEAR(c.g, 2, 4e-6);
        }
    }
}

TEST(SpecularLight, CellsAndTexelsAgreeWithThePlainSum) {
    const Environment sky = tests::lat_long_map(256, 128, tests::smooth_sky);
    for (const std::uint32_t level : {8u, 20u, 40u}) {
        const SpecularLight light = prefilter_specular(sky, {&level, 1}, {}, 0);
        const double roughness = static_cast<double>(level) / kRoughnessSteps;
        double worst = 0;
        for (int i = 0; i < 60; ++i) {
            const float t = static_cast<float>(i);
            const Vec3 r = normalize(Vec3{std::sin(t), std::cos(2.3f * t), std::sin(3.1f * t + 1)});
            const double expected = convolve(sky, r, roughness * roughness, 128);
            const double found = formats::sample_map(light.maps[0].radiance, r).g;
            worst = std::max(worst, std::abs(found / expected - 1));
        }
        // Cells, the source's texels and the bilinear result together, on a lobe of 0.2 rad.
        EXPECT_LT(worst, 0.03) << "level " << level;
    }
}

TEST(SpecularLight, ASunKeepsItsFluxAndItsPlace) {
    Environment environment;
    formats::DistantDisc sun{normalize(Vec3{0.3f, 0.8f, 0.4f}), 0.00465f, {2e4f, 2e4f, 2e4f}};
    environment.discs = {sun};
    const double flux = 2e4 * formats::disc_solid_angle(sun.angular_radius);
    for (const std::uint32_t level : {12u, 20u}) {
        const SpecularLight light = prefilter_specular(environment, {&level, 1}, {}, 0);
        const Environment& map = light.maps[0].radiance;
        const double alpha = std::pow(static_cast<double>(level) / kRoughnessSteps, 2);
        // The lobe's own values at the sun, normalised over the sphere:
        // int D(theta / 2) cos theta dw, by quadrature.
        const auto lobe = [alpha](double cosine) {
            const double d = (1 + cosine) / 2 * (alpha * alpha - 1) + 1;
            return std::max(cosine, 0.0) / (d * d);
        };
        double norm = 0;
        constexpr int kSteps = 200000;
        for (int i = 0; i < kSteps; ++i) {
            const double s = (i + 0.5) / kSteps;  // cos theta = 1 - s^2: dense at the peak
            norm += 2 * std::numbers::pi * lobe(1 - s * s) * 2 * s / kSteps;
        }
        for (const float away : {0.0f, 0.1f, 0.4f, 0.9f}) {
            const Vec3 side = normalize(cross(sun.direction, {0, 0, 1}));
            const Vec3 r = std::cos(away) * sun.direction + std::sin(away) * side;
            const double expected = flux * lobe(std::cos(away)) / norm;
            // Two texels across half the lobe: bilinear interpolation cuts its peak.
            EXPECT_NEAR(formats::sample_map(map, r).r, expected, 0.1 * expected)
                << "level " << level << ", " << away;
        }
    }
}

TEST(SpecularLight, StaysFiniteUnderAbsurdLight) {
    const float largest = std::numeric_limits<float>::max();
    Environment environment = tests::even_sky({largest, 0, 1e-38f});
    environment.discs = {{{0, 1, 0}, 0.1f, {largest, largest, 0}}};
    const SpecularLight light = prefilter_specular(environment, kAllLevels, {}, 0);
    for (const SpecularLight::Map& map : light.maps) {
        for (const Rgb c : map.radiance.pixel) {
            ASSERT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b));
            ASSERT_GE(c.g, 0);
        }
    }
    const SpecularLight black = prefilter_specular({}, kAllLevels, {}, 0);
    EXPECT_EQ(black.maps[2].radiance.pixel[100], Rgb{});
}

TEST(SpecularVisibility, OpenIsOneAndClosedIsNothingWhateverTheDirections) {
    for (const float alpha : {0.05f, 0.3f, 1.0f}) {
        const SpecularLobe lobe{nullptr, (1 - alpha * alpha) / (1 + alpha * alpha),
                                2 * alpha / (1 + alpha * alpha)};
        for (const Vec3 mirrored :
             {Vec3{0, 0, 1}, Vec3{1, 0, 0}, Vec3{0, 0, -1}, Vec3{0.6f, 0, 0.8f}}) {
            EXPECT_EQ(specular_visibility({0, 0, 1}, 1, mirrored, lobe), 1.0f);
            EXPECT_EQ(specular_visibility({0, 0, 1}, 0, mirrored, lobe), 0.0f);
            float previous = 0;
            for (int i = 1; i < 256; ++i) {  // opens with openness where it is looked at
                const float v =
                    specular_visibility({0, 0, 1}, static_cast<float>(i) / 255, {0, 0, 1}, lobe);
                EXPECT_GE(v, previous);
                previous = v;
            }
            EXPECT_EQ(previous, 1.0f);
        }
        // A quarter open along +Z: a cone of 30 degrees.
        EXPECT_GE(specular_visibility({0, 0, 1}, 0.25f, {0, 0, 1}, lobe),
                  specular_visibility({0, 0, 1}, 0.25f, normalize(Vec3{1, 0, 1}), lobe));
    }
    const SpecularLobe sharp{nullptr, 0.995f, 0.0998f};
    EXPECT_GT(specular_visibility({0, 0, 1}, 0.25f, normalize(Vec3{0.3f, 0, 1}), sharp), 0.99f);
    EXPECT_LT(specular_visibility({0, 0, 1}, 0.25f, normalize(Vec3{1, 0, 1}), sharp), 0.01f);
}

Asset make_mirror_asset(float roughness) {
    Asset asset;
    formats::PrimitiveRecord record;
    record.shading = formats::Shading::translucent;
    record.bands = 3;
    record.eta = 1.5f;
    tests::add_random_primitive(asset, 8, record, 31);
    asset.roughness = {roughness};
    for (const Vec3 normal : asset.normal) {
        asset.openness.push_back(formats::encode_openness(normal, 1));
    }
    return asset;
}

TEST(Specular, OpenReceiverUnderWhiteMirrorsWhatItDoesNotLetThrough) {
    for (const float roughness : {0.2f, 0.5f, 1.0f}) {
        const Asset asset = make_mirror_asset(roughness);
        const SpecularLight light =
            prefilter_specular(tests::even_sky({1, 1, 1}), roughness_levels(asset.view()), {}, 1);
        const SpecularLobe lobe = specular_lobe(&light, asset.view(), 0);
        ASSERT_NE(lobe.radiance, nullptr);
        for (float c = 0.01f; c <= 1; c += 0.03f) {
            const Rgb mirrored = eval_specular(light, lobe, tests::seen_at(c), 1.5f, {0, 1, 0}, 1);
            EXPECT_NEAR(mirrored.g + fresnel_transmittance(c, 1.5f), 1, 3e-6f) << c;
        }
    }
}

TEST(Specular, MirrorsTheLightWhereTheLawOfReflectionSaysAndTurnsWithIt) {
    const Asset asset = make_mirror_asset(0.2f);
    const Vec3 toward = normalize(Vec3{-0.6f, 0.8f, 0});
    const Environment spot = tests::lat_long_map(256, 128, [&](Vec3 d) {
        const float on = dot(d, toward) > 0.99f ? 1.0f : 0.0f;
        return Rgb{on, on, on};
    });
    const auto levels = roughness_levels(asset.view());
    for (const float turn : {0.0f, 0.9f}) {
        const Rotation rotation = rotation_about_y(turn);
        const SpecularLight light = prefilter_specular(spot, levels, rotation, 1);
        const SpecularLobe lobe = specular_lobe(&light, asset.view(), 0);
        const Vec3 lit = rotation.world_from_light({0.6f, 0.8f, 0});  // mirrored about +Y
        const ViewOfReceiver at{{0, 1, 0}, lit, 0.8f, false};
        const ViewOfReceiver aside{
            {0, 1, 0}, rotation.world_from_light({-0.6f, 0.8f, 0}), 0.8f, false};
        const float f = 1 - fresnel_transmittance(0.8f, 1.5f);
        // A spot of half angle 8.1 degrees catches half vectors up to h = 4.05 degrees: of a GGX
        // lobe tan^2 h / (alpha^2 + tan^2 h), alpha = 0.04.
        const float caught = 0.00502f / (0.0016f + 0.00502f);
        EXPECT_NEAR(eval_specular(light, lobe, at, 1.5f, {0, 1, 0}, 1).r, caught * f, 0.03f * f);
        EXPECT_LT(eval_specular(light, lobe, aside, 1.5f, {0, 1, 0}, 1).r, 0.01f * f);
    }
}

TEST(Specular, FadesBehindTheSilhouetteAndIsBlackWithoutANormal) {
    const Asset asset = make_mirror_asset(0.2f);
    const SpecularLight light =
        prefilter_specular(tests::even_sky({1, 1, 1}), roughness_levels(asset.view()), {}, 1);
    const SpecularLobe lobe = specular_lobe(&light, asset.view(), 0);
    const auto at = [&](float cosine) {
        return eval_specular(light, lobe, tests::seen_at(cosine), 1.5f, {0, 1, 0}, 1).r;
    };
    EXPECT_NEAR(at(0.0f), 1, 1e-5f);
    EXPECT_NEAR(at(-0.1f), 0.5f, 1e-4f);
    EXPECT_EQ(at(-0.2f), 0);
    EXPECT_EQ(at(-1.0f), 0);
    const auto own = [&](float cosine) {
        return mirrored_shares(lobe, tests::seen_at(cosine), 1.5f, {0, 1, 0}, 1).own;
    };
    EXPECT_EQ(own(0.5f), 0);
    EXPECT_NEAR(own(-0.1f), 0.5f, 1e-4f);
    EXPECT_NEAR(own(-0.2f), 1, 1e-4f);
    EXPECT_NEAR(own(-0.3f), 0.5f, 1e-4f);
    EXPECT_EQ(own(-0.4f), 0);
    EXPECT_EQ(eval_specular(light, lobe, {{0, 0, 0}, {0, 1, 0}, 0, false}, 1.5f, {0, 1, 0}, 1),
              Rgb{});
}

// Under light of radiance 1 a body that absorbs nothing shows 1, from wherever it is seen and
// whatever it stands beside: what blocks the sky in its mirror shows 1 as well. Silhouettes before
// a floor, where F is 1, were black lines before.
TEST(Specular, SilhouettesOfABodyThatStandsOnAFloorAreNotDark) {
    const Asset asset = make_mirror_asset(0.2f);
    const SpecularLight light =
        prefilter_specular(tests::even_sky({1, 1, 1}), roughness_levels(asset.view()), {}, 1);
    const EmitterLight none = dark_emitters();
    const SurfaceMaterial material = surface_material(asset.view(), 0, TermSet::all, &light, none);
    for (const float open : {0.0f, 0.3f, 0.6f, 1.0f}) {
        for (float c = -0.19f; c <= 1; c += 0.01f) {
            SurfacePoint point;
            point.radiance = point.base_color = {1, 1, 1};
            point.view = tests::seen_at(c);
            point.open_axis = normalize(Vec3{0.2f, 1, 0});
            point.open_fraction = open;
            EXPECT_NEAR(shade_surface(material, point).g, 1, 1e-5f) << c << ", open " << open;
        }
    }
}

TEST(Specular, ShadingAddsItToGlossyPrimitivesAloneAndOnlyWithItsLight) {
    const Environment sky = tests::lat_long_map(64, 32, tests::smooth_sky);
    const Asset glossy = make_mirror_asset(0.3f);
    Asset matt = glossy;
    matt.roughness = {formats::kNotGlossy};
    EXPECT_TRUE(roughness_levels(matt.view()).empty());
    const SpecularLight specular = prefilter_specular(sky, roughness_levels(glossy.view()), {}, 1);
    const LightVector light = project_environment(sky, 8);
    const auto shaded = [&](const Asset& asset, const ShadeOptions& options) {
        return tests::shaded(asset, light, options);
    };
    const Vec3 eye{0, 0, 5};
    EXPECT_EQ(shaded(matt, {.eye = eye, .specular = &specular}), shaded(matt, {.eye = eye}));
    const auto bare = shaded(glossy, {.eye = eye});
    const auto with = shaded(glossy, {.eye = eye, .specular = &specular});
    const auto alone =
        shaded(glossy, {.eye = eye, .terms = TermSet::specular, .specular = &specular});
    std::size_t lit = 0;
    for (std::size_t v = 0; v < with.size(); ++v) {
        EXPECT_NEAR(with[v].g, bare[v].g + alone[v].g, 1e-6f * with[v].g);
        const ViewOfReceiver view =
            view_receiver(glossy.primitives[0], glossy.position[v], glossy.normal[v], eye);
        const Rgb expected = eval_specular(specular, specular_lobe(&specular, glossy.view(), 0),
                                           view, 1.5f, formats::open_axis(glossy.openness[v]), 1);
        EXPECT_EQ(alone[v], expected);
        lit += alone[v].g > 0 ? 1u : 0u;
    }
    EXPECT_GT(lit, 10u);
    // What a renderer interpolates has no specular in it.
    EXPECT_EQ(shaded(glossy, {.eye = eye, .fresnel = false, .specular = &specular}),
              shaded(glossy, {.eye = eye, .fresnel = false}));
}

}  // namespace
}  // namespace opaline::runtime
