#include "bake/effects/multiple/walks/limit_views.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

std::vector<float> make_rows(glm::vec3 even, std::uint32_t stride) {
    std::vector<float> rows;
    for (int axis = 0; axis < 3; ++axis) {
        const std::vector<float> row = make_row(even[axis], stride);
        rows.insert(rows.end(), row.begin(), row.end());
    }
    return rows;
}

// A half space: T_0 = z + m and R = n in proportion (README.md, "Views").
TEST(LimitViews, HalfSpacesKeepAllOfTheirRows) {
    constexpr double kMean = 2.0 / 3;
    EXPECT_EQ(
        limit_views(make_row(0.71f + 2.0f / 3, 1), make_rows({0, 1, 0}, 1), 1, {0, 1, 0}, kMean, 1),
        1);
}

TEST(LimitViews, UnderEvenLightNoViewIsDarkerThanBlackAtAnyIndex) {
    for (const double eta : {0.5, 1.0, 1.3, 3.0}) {
        for (const std::uint32_t stride : {1u, 4u}) {
            for (const glm::vec3 view :
                 {glm::vec3(0, 50, 0), glm::vec3(0, -50, 0), glm::vec3(30, 0, -9), glm::vec3(0),
                  glm::vec3(0.01f, 0.2f, 0)}) {
                const double mean = eta > 1 ? 0.5 * (1 + std::sqrt(1 - 1 / (eta * eta))) : 0.6;
                const float factor = limit_views(make_row(1, stride), make_rows(view, stride),
                                                 stride, {0, 1, 0}, mean, eta);
                EXPECT_GE(factor, 0);
                EXPECT_LE(factor, 1);
                const double least = eta > 1 ? std::sqrt(1 - 1 / (eta * eta)) : 0;
                for (double c = least; c <= 1; c += 0.02) {
                    const double across =
                        std::sqrt(1 - c * c) *
                        std::hypot(static_cast<double>(view.x), static_cast<double>(view.z));
                    const double along = (c - mean) * static_cast<double>(view.y);
                    EXPECT_GE(1 + static_cast<double>(factor) * (along - across), -1e-5)
                        << eta << " " << view.x << " " << view.y << " " << c;
                }
            }
        }
    }
}

TEST(LimitViews, WhereNoLightIsLeftNoneDependsOnTheView) {
    EXPECT_EQ(limit_views(make_row(0, 1), make_rows({0, 1, 0}, 1), 1, {0, 1, 0}, 0.7, 1), 0);
    EXPECT_EQ(limit_views(make_row(-1, 1), make_rows({0, 1, 0}, 1), 1, {0, 1, 0}, 0.7, 1), 0);
    EXPECT_EQ(limit_views(make_row(0, 1), make_rows({0, 0, 0}, 1), 1, {0, 1, 0}, 0.7, 1), 1);
}

}  // namespace
}  // namespace opaline::bake
