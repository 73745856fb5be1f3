#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bake/reference/ggx.h"
#include "bake/reference/glossy_brdf.h"
#include "bake/reference/random_stream.h"
#include "tests/bake/reference/chi_square.h"

namespace opaline::tests {
namespace {

using bake::GlossyBrdf;
using bake::OpaqueSurface;

constexpr std::array<float, 4> kRoughnesses = {0.1f, 0.3f, 0.6f, 1.0f};
constexpr std::array<float, 4> kCosines = {1.0f, 0.7f, 0.35f, 0.1f};

OpaqueSurface white_metal(float roughness) {
    return {glm::vec3(1), 1, roughness, glm::vec3(0.04f), 1};
}
OpaqueSurface white_dielectric(float roughness) {
    return {glm::vec3(1), 0, roughness, glm::vec3(0.04f), 1};
}
OpaqueSurface coloured(float metallic, float roughness) {
    return {glm::vec3(0.9f, 0.5f, 0.1f), metallic, roughness, glm::vec3(0.02f, 0.05f, 0.4f), 0.8f};
}

/// A normal that no axis is special to.
const glm::vec3 kNormal = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));

glm::vec3 direction(float cosine, float turn) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return glm::normalize(
        bake::make_frame(kNormal).to_world({sine * std::cos(turn), sine * std::sin(turn), cosine}));
}

GlossyBrdf seen(const OpaqueSurface& surface, float cosine) {
    return bake::make_glossy_brdf(surface, kNormal, direction(cosine, 0.6f));
}

std::string describe_lobe(float roughness, float cosine) {
    return "roughness " + std::to_string(roughness) + " cosine " + std::to_string(cosine);
}

/// Lambda of [Heitz2014], from the tangent of the angle: another way to write masking.
double lambda(double cosine, double alpha) {
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    return (std::sqrt(1 + alpha * alpha * tangent * tangent) - 1) / 2;
}

/// The albedo by sampling D instead of the visible normals: over u = cos^2-distributed normals,
/// E = mean of G2 F (o.h) / ((n.o)(n.h)).
bake::DirectionalAlbedo albedo_over_normals(double cosine, double roughness, int steps) {
    const double alpha = bake::ggx_alpha(roughness);
    const glm::dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
    double normal = 0, grazing = 0;
    for (int i = 0; i < steps; ++i) {
        // u = s^4 crowds steep normals, which matter at grazing; du = 4 s^3 ds.
        const double s = (i + 0.5) / steps, u = s * s * s * s, du = 4 * s * s * s;
        const double tangent2 = alpha * alpha * (1 - u) / u;
        const double z = 1 / std::sqrt(1 + tangent2), r = std::sqrt(tangent2) * z;
        for (int j = 0; j < steps; ++j) {
            const double phi = std::numbers::pi * (j + 0.5) / steps;
            const glm::dvec3 h(r * std::cos(phi), r * std::sin(phi), z);
            const double o_h = glm::dot(o, h), c_l = 2 * o_h * z - cosine;
            if (o_h > 0 && c_l > 0) {
                const double g2 = 1 / (1 + lambda(cosine, alpha) + lambda(c_l, alpha));
                const double value = du * g2 * o_h / (cosine * z);
                normal += value * (1 - std::pow(1 - o_h, 5));
                grazing += value * std::pow(1 - o_h, 5);
            }
        }
    }
    const double count = static_cast<double>(steps) * steps;
    return {normal / count, grazing / count};
}

TEST(ReferenceAlbedo, QuadratureAgreesWithOneOverAllNormals) {
    for (const double roughness : {0.1, 0.3, 0.6, 1.0}) {
        for (const double cosine : {0.999, 0.7, 0.35, 0.1}) {
            const auto fine = albedo_over_normals(cosine, roughness, 300);
            const auto coarse = bake::integrate_albedo(cosine, roughness, 32);
            EXPECT_NEAR(coarse.normal, fine.normal, 1e-3) << roughness << " " << cosine;
            EXPECT_NEAR(coarse.grazing, fine.grazing, 1e-3) << roughness << " " << cosine;
        }
    }
}

TEST(ReferenceAlbedo, TableIsWithinItsStatedErrorBetweenNodes) {
    for (int i = 0; i < 24; ++i) {
        for (int j = 0; j < 40; ++j) {
            const double cosine = bake::kGrazingCosine * std::pow(1000, (i + 0.5) / 24);
            const double roughness = (j + 0.37) / 40;
            const double fine = bake::integrate_albedo(cosine, roughness, 80).unit();
            EXPECT_NEAR(bake::directional_albedo(cosine, roughness).unit(), fine,
                        roughness < 0.1 ? bake::kSmoothAlbedoError : bake::kAlbedoError)
                << roughness << " " << cosine;
        }
    }
}

// What samples carry on average, plus the diffuse part, is all there is.
TEST(ReferenceGloss, WhiteFurnaceReturnsAllLight) {
    for (const float roughness : kRoughnesses) {
        for (const float cosine : kCosines) {
            for (const OpaqueSurface& surface :
                 {white_metal(roughness), white_dielectric(roughness)}) {
                const GlossyBrdf brdf = seen(surface, cosine);
                constexpr std::uint32_t kSamples = 100000;
                glm::dvec3 sum(0);
                for (std::uint32_t i = 0; i < kSamples; ++i) {
                    bake::RandomStream random(11, 0, i);
                    const float u = random.next(), v = random.next();
                    if (const auto sample = bake::sample_mirrored(brdf, u, v)) {
                        sum += glm::dvec3(sample->weight);
                    }
                }
                const glm::dvec3 specular = sum / double{kSamples};
                EXPECT_NEAR(specular.y, brdf.mirrored_albedo.y, 0.004)
                    << describe_lobe(roughness, cosine);
                EXPECT_NEAR(specular.y + brdf.diffuse_albedo.y, 1, 0.005)
                    << describe_lobe(roughness, cosine) << " metallic " << surface.metallic;
            }
        }
    }
}

TEST(ReferenceGloss, NeverReflectsMoreThanArrives) {
    for (float roughness = 0; roughness <= 1; roughness += 0.05f) {
        for (float cosine = 0.01f; cosine <= 1; cosine += 0.03f) {
            for (const float metallic : {0.0f, 0.3f, 1.0f}) {
                const GlossyBrdf brdf = seen(coloured(metallic, roughness), cosine);
                const glm::vec3 all = brdf.mirrored_albedo + brdf.diffuse_albedo;
                EXPECT_LE(std::max({all.x, all.y, all.z}), 1 + 1e-6f)
                    << describe_lobe(roughness, cosine);
                EXPECT_GE(std::min({all.x, all.y, all.z}), 0) << describe_lobe(roughness, cosine);
            }
        }
    }
}

TEST(ReferenceGloss, WithoutCompensationTheLobeIsReciprocal) {
    for (const float roughness : kRoughnesses) {
        for (const float a : kCosines) {
            for (const float b : kCosines) {
                const OpaqueSurface surface = coloured(0.5f, roughness);
                const glm::vec3 one = direction(a, 0.2f), other = direction(b, 2.4f);
                const GlossyBrdf from_one = bake::make_glossy_brdf(surface, kNormal, one);
                const GlossyBrdf from_other = bake::make_glossy_brdf(surface, kNormal, other);
                const glm::dvec3 f = glm::dvec3(bake::eval_mirrored(from_one, other).response) /
                                     (from_one.compensation * static_cast<double>(b));
                const glm::dvec3 g = glm::dvec3(bake::eval_mirrored(from_other, one).response) /
                                     (from_other.compensation * static_cast<double>(a));
                for (const int c : {0, 1, 2}) {
                    EXPECT_NEAR(f[c], g[c], 1e-4 * f[c]) << describe_lobe(roughness, a);
                }
            }
        }
    }
}

TEST(ReferenceGloss, SamplesWeighWhatTheirResponseOverDensitySays) {
    for (const float roughness : kRoughnesses) {
        for (const float cosine : kCosines) {
            const GlossyBrdf brdf = seen(coloured(0.5f, roughness), cosine);
            for (std::uint32_t i = 0; i < 200; ++i) {
                bake::RandomStream random(5, 1, i);
                const float u = random.next(), v = random.next();
                const auto sample = bake::sample_mirrored(brdf, u, v);
                if (!sample || glm::dot(sample->direction, kNormal) < 1e-3f) {
                    continue;  // rounding of the cosine matters there
                }
                const bake::LobeValue value = bake::eval_mirrored(brdf, sample->direction);
                // Directions are floats: at alpha 0.01 the lobe turns 6e-8 into 1e-4.
                EXPECT_NEAR(value.pdf, sample->pdf, 2e-3f * sample->pdf);
                for (const int c : {0, 1, 2}) {
                    EXPECT_NEAR(value.response[c], sample->weight[c] * value.pdf,
                                1e-3f * value.response[c]);
                }
            }
        }
    }
}

TEST(ReferenceGloss, DirectionsAreDistributedAsTheirDensitySays) {
    for (const float roughness : {0.3f, 0.6f, 1.0f}) {
        for (const float cosine : kCosines) {
            const GlossyBrdf brdf = seen(white_metal(roughness), cosine);
            expect_distribution(
                brdf.frame, 0, 200000,
                [&](glm::vec3 d) { return bake::eval_mirrored(brdf, d).pdf; },
                [&](bake::RandomStream& random) -> std::optional<glm::vec3> {
                    const float u = random.next(), v = random.next();
                    const auto sample = bake::sample_mirrored(brdf, u, v);
                    return sample ? std::optional(sample->direction) : std::nullopt;
                },
                describe_lobe(roughness, cosine));
        }
    }
}

TEST(ReferenceGloss, EyesBelowTheHorizonCountAsGrazing) {
    const GlossyBrdf brdf = bake::make_glossy_brdf(white_metal(0.5f), kNormal, -kNormal);
    EXPECT_GT(brdf.to_eye.z, 0);
    EXPECT_NEAR(glm::length(brdf.to_eye), 1, 1e-12);
    EXPECT_TRUE(std::isfinite(brdf.mirrored_albedo.x));
}

}  // namespace
}  // namespace opaline::tests
