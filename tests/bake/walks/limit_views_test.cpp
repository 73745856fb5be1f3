#include "bake/effects/multiple/walks/limit_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kTexels = 24, kFace = 4;  // 2 x 2 a face

// Rows that make `even` of even light, in all bands.
std::vector<float> make_row(float even, std::uint32_t stride) {
    std::vector<float> row(kTexels * stride, 0);
    for (std::size_t f = 0; f < 6; ++f) {
        for (std::uint32_t band = 0; band < stride; ++band) {
            row[f * kFace * stride + band] = even / 6;
            row[(f * kFace + 1) * stride + band] = 100;  // no even light
        }
    }
    return row;
}

std::vector<float> make_rows(const std::vector<float>& even, std::uint32_t stride) {
    std::vector<float> rows;
    for (const float value : even) {
        const std::vector<float> row = make_row(value, stride);
        rows.insert(rows.end(), row.begin(), row.end());
    }
    return rows;
}

ViewLimit limit(float even, const std::vector<float>& rows, glm::vec3 normal, double eta,
                std::uint32_t stride = 1) {
    return limit_views(make_row(even, stride), make_rows(rows, stride), stride, normal,
                       make_view_fit(eta));
}

// The darkest view of T_0 = 1 with limited rows.
double darkest(const std::vector<float>& rows, const ViewLimit& limit, glm::vec3 normal,
               double eta) {
    const ViewFit fit = make_view_fit(eta);
    const ViewMatrix matrix = to_harmonics(fit, normal);
    std::array<float, 9> harmonics{};
    for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t k = 0; k < harmonics.size(); ++k) {
            harmonics[k] +=
                (r < kFirstDegree ? limit.first : limit.second) * matrix[k][r] * rows[r];
        }
    }
    const Frame frame = make_frame(normal);
    double least = 1;
    for (int i = 0; i <= 50; ++i) {
        const double c = fit.steepest + (1 - fit.steepest) * i / 50, s = std::sqrt(1 - c * c);
        for (int k = 0; k < 60; ++k) {
            const double angle = 2 * std::numbers::pi * k / 60;
            const glm::vec3 w = frame.to_world({s * std::cos(angle), s * std::sin(angle), c});
            std::array<float, 9> value{};
            formats::eval_spherical_harmonics({w.x, w.y, w.z}, value);
            double seen = 1;
            for (std::size_t h = 0; h < value.size(); ++h) {
                seen += static_cast<double>(harmonics[h] * value[h]);
            }
            least = std::min(least, seen);
        }
    }
    return least;
}

// A half space: T_0 = z + m and R = n in proportion (README.md, "Views").
TEST(LimitViews, HalfSpacesKeepAllOfTheirRows) {
    for (const std::vector<float>& rows :
         {std::vector<float>{0, 1, 0}, std::vector<float>{0, 1, 0, 0, 0, 0, 0, 0}}) {
        const ViewLimit kept = limit(0.71f + 2.0f / 3, rows, {0, 1, 0}, 1);
        EXPECT_EQ(kept.first, 1);
        EXPECT_EQ(kept.second, 1);
    }
}

TEST(LimitViews, UnderEvenLightNoViewIsDarkerThanBlackAtAnyIndex) {
    const glm::vec3 tilted = glm::normalize(glm::vec3(0.5f, 0.4f, -0.7f));
    for (const double eta : {0.5, 1.0, 1.3, 3.0}) {
        for (const std::uint32_t stride : {1u, 4u}) {
            for (const glm::vec3 normal : {glm::vec3(0, 1, 0), tilted}) {
                for (const std::vector<float>& rows :
                     {std::vector<float>{0, 50, 0}, std::vector<float>{0, -50, 0},
                      std::vector<float>{30, 0, -9}, std::vector<float>{0, 0, 0},
                      std::vector<float>{0.01f, 0.2f, 0},
                      std::vector<float>{0, 1, 0, 3, -8, 20, 7, 9},
                      std::vector<float>{9, -2, 4, 0.1f, 0.2f, -0.4f, 0, 0.3f},
                      std::vector<float>{0.2f, 0.1f, 0, -60, 2, 0.3f, 40, -11}}) {
                    const ViewLimit kept = limit(1, rows, normal, eta, stride);
                    EXPECT_GE(kept.first, 0);
                    EXPECT_LE(kept.first, 1);
                    EXPECT_GE(kept.second, 0);
                    EXPECT_LE(kept.second, 1);
                    EXPECT_GE(darkest(rows, kept, normal, eta), -1e-4)
                        << eta << " " << rows[0] << " " << rows[1] << " " << rows.size();
                }
            }
        }
    }
}

// The limit of degree two assumes that its two azimuths agree.
TEST(LimitViews, TakesNoMoreThanItMust) {
    for (const std::vector<float>& rows :
         {std::vector<float>{3, 5, -2}, std::vector<float>{0, 0, 0, 3, -8, 20, 7, 9}}) {
        const glm::vec3 normal = glm::normalize(glm::vec3(0.5f, 0.4f, -0.7f));
        EXPECT_LT(darkest(rows, limit(1, rows, normal, 1), normal, 1),
                  rows.size() == 3 ? 0.02 : 0.4)
            << rows.size();
    }
}

// 1 + 2.2 (c' - m) + 1.2 (P_2 - a - b (c' - m)) is a peak along the normal that is nowhere
// negative, though its linear part is: nothing is taken from it.
TEST(LimitViews, APeakThatOnlyBothDegreesHoldStaysWhole) {
    const float zonal = 1 / second_harmonic(6)[2][2];  // of P_2 about z
    const std::vector<float> rows{0, 0, 2.2f, 0, 0, 1.2f * zonal, 0, 0};
    const glm::vec3 up(0, 0, 1);
    EXPECT_LT(limit(1, {0, 0, 2.2f}, up, 1).first, 0.8f);
    const ViewLimit kept = limit(1, rows, up, 1);
    EXPECT_EQ(kept.first, 1);
    EXPECT_EQ(kept.second, 1);
}

// Noise of degree two does not take what the first degree holds by itself.
TEST(LimitViews, NoiseOfDegreeTwoLeavesTheFirstDegreeAsItIs) {
    const ViewLimit kept = limit(1, {0, 0.6f, 0, 90, -70, 60, 40, 30}, {0, 1, 0}, 1);
    EXPECT_EQ(kept.first, 1);
    EXPECT_LT(kept.second, 0.1f);
}

TEST(LimitViews, WhereNoLightIsLeftNoneDependsOnTheView) {
    EXPECT_EQ(limit(0, {0, 1, 0}, {0, 1, 0}, 1).first, 0);
    EXPECT_EQ(limit(-1, {0, 1, 0}, {0, 1, 0}, 1).first, 0);
    EXPECT_EQ(limit(0, {0, 0, 0}, {0, 1, 0}, 1).first, 1);
}

}  // namespace
}  // namespace opaline::bake
