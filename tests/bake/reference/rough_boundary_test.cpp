// Facets of a dielectric boundary: what they reflect and refract.
#include "bake/reference/rough_boundary.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bake/reference/ggx.h"
#include "bake/reference/random_stream.h"
#include "tests/bake/reference/chi_square.h"

namespace opaline::tests {
namespace {

using bake::RoughBoundary;

constexpr std::array<float, 3> kWidths = {0.04f, 0.3f, 0.9f};
constexpr std::array<float, 3> kIndices = {1.5f, 1 / 1.5f, 1.1f};
constexpr std::array<float, 3> kEyeCosines = {0.98f, 0.6f, 0.15f};
const glm::vec3 kUpOfFacets = glm::normalize(glm::vec3(0.3f, 0.8f, -0.5f));

glm::vec3 facet_direction(float cosine, float turn) {
    const float sine = std::sqrt(1 - cosine * cosine);
    return glm::normalize(bake::make_frame(kUpOfFacets)
                              .to_world({sine * std::cos(turn), sine * std::sin(turn), cosine}));
}

RoughBoundary boundary_seen(float alpha, float ratio, float cosine) {
    return bake::make_rough_boundary(kUpOfFacets, facet_direction(cosine, 0.6f), alpha, ratio);
}

std::string describe_boundary(float alpha, float ratio, float cosine) {
    return "alpha " + std::to_string(alpha) + " ratio " + std::to_string(ratio) + " cosine " +
           std::to_string(cosine);
}

template <class Check>
void for_all_boundaries(Check&& check) {
    for (const float alpha : kWidths) {
        for (const float ratio : kIndices) {
            for (const float cosine : kEyeCosines) {
                check(boundary_seen(alpha, ratio, cosine), describe_boundary(alpha, ratio, cosine));
            }
        }
    }
}

/// 1 / (1 + Lambda) of [Heitz2014], from the tangent of the angle.
double masked(double cosine, double alpha) {
    const double tangent = std::sqrt(1 - cosine * cosine) / cosine;
    return 2 / (1 + std::sqrt(1 + alpha * alpha * tangent * tangent));
}

/// What the boundary returns of even light: an integral over all normals, in proportion to D cos,
/// instead of those that the eye sees; Fresnel's formulas by the angle of refraction.
double albedo_by_normals(double alpha, double n, double cosine, bool reflected) {
    constexpr int kSteps = 350;
    const glm::dvec3 o(std::sqrt(1 - cosine * cosine), 0, cosine);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        // u = s^4 crowds steep normals.
        const double s = (i + 0.5) / kSteps, u = s * s * s * s, du = 4 * s * s * s;
        const double tangent2 = alpha * alpha * (1 - u) / u;
        const double z = 1 / std::sqrt(1 + tangent2), r = std::sqrt(tangent2) * z;
        for (int j = 0; j < kSteps; ++j) {
            const double phi = std::numbers::pi * (j + 0.5) / kSteps;
            const glm::dvec3 h(r * std::cos(phi), r * std::sin(phi), z);
            const double c = glm::dot(o, h);
            if (!(c > 0)) continue;
            const double sine_t = std::sqrt(1 - c * c) / n;
            double fresnel = 1, c_t = 0;
            if (sine_t < 1) {
                c_t = std::sqrt(1 - sine_t * sine_t);
                const double s_pol = (c - n * c_t) / (c + n * c_t);
                const double p_pol = (n * c - c_t) / (n * c + c_t);
                fresnel = 0.5 * (s_pol * s_pol + p_pol * p_pol);
            }
            const double seen = du * c / (cosine * z);
            const double up = 2 * c * z - cosine;
            if (reflected && up > 0) {
                const double both = 1 / (1 / masked(cosine, alpha) + 1 / masked(up, alpha) - 1);
                sum += seen * fresnel * both;
            }
            const double down = cosine / n - (c / n - c_t) * z;  // -l.z
            if (!reflected && c_t > 0 && down > 0) {
                sum += seen * (1 - fresnel) * masked(cosine, alpha) * masked(down, alpha);
            }
        }
    }
    return sum / (double{kSteps} * kSteps);
}

TEST(RoughBoundary, SamplesReturnWhatAnIntegralOverNormalsSaysOnEachSide) {
    for_all_boundaries([](const RoughBoundary& boundary, const std::string& what) {
        constexpr std::uint32_t kGrid = 250;
        double here = 0, beyond = 0;
        for (std::uint32_t i = 0; i < kGrid * kGrid; ++i) {
            bake::RandomStream random(3, 0, i);
            const float u = (static_cast<float>(i % kGrid) + random.next()) / kGrid;
            const float v = (static_cast<float>(i / kGrid) + random.next()) / kGrid;
            if (const auto s = sample_rough_boundary(boundary, u, v, random.next())) {
                (s->transmits ? beyond : here) += static_cast<double>(s->weight);
                ASSERT_LE(s->weight, 1.0f);
            }
        }
        constexpr double kCount = double{kGrid} * kGrid;
        const double cosine = boundary.to_eye.z;
        EXPECT_NEAR(here / kCount, albedo_by_normals(boundary.alpha, boundary.ratio, cosine, true),
                    5e-3)
            << what;
        EXPECT_NEAR(beyond / kCount,
                    albedo_by_normals(boundary.alpha, boundary.ratio, cosine, false), 5e-3)
            << what;
    });
}

TEST(RoughBoundary, SamplesWeighWhatTheirResponseOverDensitySays) {
    for_all_boundaries([](const RoughBoundary& given, const std::string& what) {
        for (const auto& [reflects, transmits] :
             {std::pair(true, true), std::pair(true, false), std::pair(false, true)}) {
            RoughBoundary boundary = given;
            boundary.reflects = reflects;
            boundary.transmits = transmits;
            for (std::uint32_t i = 0; i < 150; ++i) {
                bake::RandomStream random(5, 1, i);
                const float u = random.next(), v = random.next();
                const auto s = sample_rough_boundary(boundary, u, v, random.next());
                if (!s || std::abs(glm::dot(s->direction, kUpOfFacets)) < 1e-2f) {
                    continue;  // rounding of the cosine matters there
                }
                EXPECT_TRUE(s->transmits ? transmits : reflects);
                const bake::BoundaryValue value = eval_rough_boundary(boundary, s->direction);
                // Directions are floats; at an index of 1.1 their errors count ten times.
                EXPECT_NEAR(value.pdf, s->pdf, 2e-3f * s->pdf) << what;
                EXPECT_NEAR(value.response, s->weight * value.pdf, 2e-3f * value.response) << what;
            }
        }
    });
}

// f(o, l) / n_l^2 = f(l, o) / n_o^2, reflected and refracted.
TEST(RoughBoundary, IsReciprocal) {
    for (const float alpha : {0.3f, 0.9f}) {
        for (const float ratio : {1.5f, 0.7f}) {
            for (const float a : kEyeCosines) {
                for (const float b : {0.9f, 0.5f, -0.4f, -0.8f, -0.97f}) {
                    const glm::vec3 o = facet_direction(a, 0.2f), l = facet_direction(b, 3);
                    const float side = b > 0 ? 1.0f : -1.0f;
                    const auto there = bake::make_rough_boundary(kUpOfFacets, o, alpha, ratio);
                    const auto back = bake::make_rough_boundary(side * kUpOfFacets, l, alpha,
                                                                b > 0 ? ratio : 1 / ratio);
                    const float f = eval_rough_boundary(there, l).response / std::abs(b);
                    const float g = eval_rough_boundary(back, o).response / a;
                    EXPECT_NEAR(b > 0 ? f : f / (ratio * ratio), g, 5e-4f * g + 1e-12f)
                        << describe_boundary(alpha, ratio, a) << " to " << b;
                }
            }
        }
    }
    const auto there = bake::make_rough_boundary(kUpOfFacets, facet_direction(0.6f, 0), 0.3f, 1.5f);
    EXPECT_GT(eval_rough_boundary(there, facet_direction(-0.85f, 3.14f)).response, 0.1f);
}

TEST(RoughBoundary, DirectionsAreDistributedAsTheirDensitySays) {
    for (const float alpha : {0.3f, 0.9f}) {
        for (const float ratio : {1.5f, 1 / 1.5f}) {
            for (const float cosine : kEyeCosines) {
                const RoughBoundary boundary = boundary_seen(alpha, ratio, cosine);
                // Cells about an axis in the surface: lobes lie away from the poles.
                expect_distribution(
                    bake::make_frame(boundary.frame.u), -1, 60000,
                    [&](glm::vec3 d) { return eval_rough_boundary(boundary, d).pdf; },
                    [&](bake::RandomStream& random) -> std::optional<glm::vec3> {
                        const float u = random.next(), v = random.next();
                        const auto sample = sample_rough_boundary(boundary, u, v, random.next());
                        return sample ? std::optional(sample->direction) : std::nullopt;
                    },
                    describe_boundary(alpha, ratio, cosine));
            }
        }
    }
}

TEST(RoughBoundary, WithNarrowFacetsIsTheSmoothOne) {
    for (const float ratio : {1.5f, 1 / 1.5f}) {
        for (const float cosine : {0.98f, 0.8f}) {
            const RoughBoundary boundary = boundary_seen(1e-3f, ratio, cosine);
            const bake::BoundarySplit split =
                bake::split_at_boundary(-facet_direction(cosine, 0.6f), kUpOfFacets, ratio);
            constexpr int kSamples = 4000;
            int reflected = 0, near = 0;
            for (std::uint32_t i = 0; i < kSamples; ++i) {
                bake::RandomStream random(9, 2, i);
                const float u = random.next(), v = random.next();
                const auto s = sample_rough_boundary(boundary, u, v, random.next());
                ASSERT_TRUE(s);
                reflected += s->transmits ? 0 : 1;
                const glm::vec3 middle = s->transmits ? split.transmitted : split.reflected;
                near += glm::distance(s->direction, middle) < 0.02f ? 1 : 0;
            }
            const double p = static_cast<double>(split.reflectance);
            EXPECT_NEAR(reflected, kSamples * p, 4 * std::sqrt(kSamples * p * (1 - p)));
            EXPECT_GT(near, 0.98 * kSamples);
        }
    }
}

}  // namespace
}  // namespace opaline::tests
