#include "formats/opal/gloss_model.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::formats {
namespace {

// Directional albedo straight from D, V and Schlick's term: the midpoint rule over directions of
// light, dense toward the mirror direction's polar angle. Knows nothing of visible normals.
GgxAlbedo sum_over_light(double cosine, double alpha) {
    constexpr int kPolar = 900, kAzimuth = 400;
    const double sine = std::sqrt(1 - cosine * cosine);
    double of_f0 = 0, of_f90 = 0;
    for (int i = 0; i < kPolar; ++i) {
        const double theta = (i + 0.5) / kPolar * std::numbers::pi / 2;
        for (int j = 0; j < kAzimuth; ++j) {
            const double phi = (j + 0.5) / kAzimuth * std::numbers::pi;
            const double lx = std::sin(theta) * std::cos(phi), ly = std::sin(theta) * std::sin(phi),
                         lz = std::cos(theta);
            const double hx = lx + sine, hz = lz + cosine;
            const double norm = std::sqrt(hx * hx + ly * ly + hz * hz);
            const double v_h = (sine * hx + cosine * hz) / norm;
            const auto a = static_cast<float>(alpha);
            const double lobe = static_cast<double>(
                ggx_distribution(static_cast<float>(hz / norm), a) *
                smith_visibility(static_cast<float>(cosine), static_cast<float>(lz), a));
            const double weight = lobe * lz * std::sin(theta) * (std::numbers::pi / 2 / kPolar) *
                                  (2 * std::numbers::pi / kAzimuth);
            const auto schlick = static_cast<double>(schlick_weight(static_cast<float>(v_h)));
            of_f0 += weight * (1 - schlick);
            of_f90 += weight * schlick;
        }
    }
    return {static_cast<float>(of_f0), static_cast<float>(of_f90)};
}

TEST(GgxAlbedo, VisibleNormalsAndDirectionsOfLightGiveTheSame) {
    for (const double roughness : {0.3, 0.5, 0.8, 1.0}) {
        for (const double cosine : {0.1, 0.4, 0.9}) {
            const double alpha = roughness * roughness;
            const GgxAlbedo expected = sum_over_light(cosine, alpha);
            const GgxAlbedo found = integrate_ggx_albedo(cosine, alpha, 160);
            EXPECT_NEAR(found.of_f0, expected.of_f0, 1e-3) << roughness << ' ' << cosine;
            EXPECT_NEAR(found.of_f90, expected.of_f90, 1e-3) << roughness << ' ' << cosine;
        }
    }
}

float worst_of_table(float least_cosine, float least_roughness) {
    float worst = 0;
    for (int i = 0; i < 23; ++i) {
        for (int j = 0; j < 23; ++j) {
            const float x = (static_cast<float>(i) + 0.37f) / 23,
                        y = (static_cast<float>(j) + 0.5f) / 23;
            const float roughness = least_roughness + (1 - least_roughness) * x;
            const float cosine = least_cosine + (1 - least_cosine) * y * y;
            const GgxAlbedo exact = integrate_ggx_albedo(
                static_cast<double>(cosine), static_cast<double>(ggx_alpha(roughness)), 160);
            const GgxAlbedo found = ggx_albedo(cosine, roughness);
            worst = std::max({worst, std::abs(found.of_f0 - exact.of_f0),
                              std::abs(found.of_f90 - exact.of_f90),
                              std::abs(found.e1() - exact.e1())});
        }
    }
    return worst;
}

TEST(GgxAlbedo, TheTableKeepsItsStatedError) {
    EXPECT_LT(worst_of_table(0.1f, 0), 1e-3f);
    EXPECT_LT(worst_of_table(0.001f, 0.1f), 2.5e-3f);
    EXPECT_LT(worst_of_table(0.001f, 0), 1e-2f);
}

TEST(GgxAlbedo, ClampsWhatLiesOutside) {
    EXPECT_EQ(ggx_albedo(2, 0.5f).e1(), ggx_albedo(1, 0.5f).e1());
    EXPECT_EQ(ggx_albedo(-1, 3).e1(), ggx_albedo(0, 1).e1());
}

GlossRecord dielectric(float f0, float f90 = 1) {
    GlossRecord record;
    record.f0 = {f0, f0, f0};
    record.f90 = f90;
    record.roughness = 1;
    return record;
}

// White light on a white surface: nothing is lost, whatever it is made of.
TEST(GlossModel, WhiteFurnace) {
    for (const float metallic : {0.0f, 0.3f, 1.0f}) {
        for (const float roughness : {0.05f, 0.3f, 0.6f, 1.0f}) {
            const GlossSurface surface =
                make_gloss_surface(dielectric(0.04f), {1, 1, 1}, metallic, roughness);
            for (float c = 0.02f; c <= 1; c += 0.07f) {
                const GlossAlbedo albedo = eval_gloss_albedo(surface, c);
                if (metallic == 0 || metallic == 1) {
                    EXPECT_NEAR(albedo.specular.g + albedo.diffuse, 1, 1e-5f) << roughness;
                } else {  // part of what is not mirrored would have been a metal's diffuse light
                    EXPECT_LE(albedo.specular.g + albedo.diffuse, 1 + 1e-5f);
                }
            }
        }
    }
}

TEST(GlossModel, NoChannelReflectsMoreThanItReceives) {
    for (const Rgb color : {Rgb{1, 0.7f, 0.3f}, Rgb{0.2f, 0.2f, 0.2f}, Rgb{5, 0, 1}}) {
        for (const float metallic : {0.0f, 0.5f, 1.0f}) {
            const GlossSurface surface =
                make_gloss_surface(dielectric(0.08f, 0.5f), color, metallic, 0.7f);
            for (float c = 0.02f; c <= 1; c += 0.07f) {
                const GlossAlbedo albedo = eval_gloss_albedo(surface, c);
                const Rgb diffuse = albedo.diffuse * Rgb{std::min(color.r, 1.0f), color.g, color.b};
                EXPECT_LE(albedo.specular.r + diffuse.r, 1 + 1e-5f);
                EXPECT_LE(albedo.specular.g + diffuse.g, 1 + 1e-5f);
                EXPECT_GE(albedo.diffuse, 0);
            }
        }
    }
}

TEST(GlossModel, AMetalHasItsColourAndNoDiffuseLight) {
    const GlossSurface gold = make_gloss_surface(dielectric(0.04f), {1, 0.7f, 0.3f}, 1, 0.4f);
    EXPECT_EQ(gold.f0, (Rgb{1, 0.7f, 0.3f}));
    EXPECT_EQ(gold.f90, 1);
    EXPECT_EQ(eval_gloss_albedo(gold, 0.8f).diffuse, 0);
    const GlossSurface none = make_gloss_surface(dielectric(0, 0), {0.5f, 0.5f, 0.5f}, 0, 0.4f);
    EXPECT_EQ(eval_gloss_albedo(none, 0.8f).diffuse, 1);
    EXPECT_EQ(eval_gloss_albedo(none, 0.8f).specular, Rgb{});
}

}  // namespace
}  // namespace opaline::formats
