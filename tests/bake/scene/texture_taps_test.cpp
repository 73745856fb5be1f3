#include "bake/scene/sample_image.h"

#include <gtest/gtest.h>

#include <cmath>

namespace opaline::bake {
namespace {

UvMoments spanned_by(glm::dvec2 a, glm::dvec2 b) {
    UvMoments moments;
    moments.add(a);
    moments.add(b);
    return moments;
}

// The skewed pair of the specification: 0.74 texels wide, not 9.06 as its shorter vector.
TEST(TextureTaps, SkewedPairsAreAsWideAsTheirSmallerSingularValue) {
    const TextureTaps taps = texture_taps(spanned_by({10, 0}, {9, 1}), {1, 1}, 16);
    EXPECT_NEAR(taps.minor, 0.74, 0.005);
    EXPECT_EQ(taps.count, static_cast<int>(std::ceil(taps.major)));
    EXPECT_EQ(taps.level, 0);
    EXPECT_NEAR(std::sqrt(82.0), 9.06, 0.005);
}

TEST(TextureTaps, TapsAreSpreadEvenlyOverTheMajorAxis) {
    const TextureTaps taps =
        texture_taps(spanned_by({8.0 / 256, 0}, {0, 2.0 / 256}), {256, 256}, 16);
    EXPECT_EQ(taps.count, 4);
    EXPECT_NEAR(taps.level, 1, 1e-14);
    glm::dvec2 sum(0);
    for (int i = 0; i < taps.count; ++i) {
        sum += taps.offset(i);
    }
    EXPECT_LT(glm::length(sum), 1e-16);
    EXPECT_NEAR(std::abs(taps.offset(0).x), 3.0 / 256, 1e-16);
    EXPECT_NEAR(taps.offset(0).y, 0, 1e-16);
}

TEST(TextureTaps, MostTapsBoundTheirNumberAndBlurTheRest) {
    const TextureTaps taps = texture_taps(spanned_by({128, 0}, {0, 1}), {1, 1}, 16);
    EXPECT_EQ(taps.count, 16);
    EXPECT_NEAR(taps.level, 3, 1e-14);
}

// Hard cases: a point, a line, less than a texel.
TEST(TextureTaps, PointsAndLinesReadTheFinestLevelTheyCan) {
    const TextureTaps point = texture_taps({}, {512, 512}, 16);
    EXPECT_EQ(point.count, 1);
    EXPECT_EQ(point.level, 0);
    EXPECT_EQ(point.offset(0), glm::dvec2(0));
    const TextureTaps line = texture_taps(spanned_by({12, 0}, {6, 0}), {1, 1}, 16);
    EXPECT_EQ(line.count, 14);
    EXPECT_EQ(line.minor, 0);
    EXPECT_EQ(line.level, 0);
}

TEST(TextureTaps, TexelsThatAreNotSquareCountAsSuch) {
    const TextureTaps taps = texture_taps(spanned_by({0.1, 0}, {0, 0.1}), {1024, 16}, 16);
    EXPECT_NEAR(taps.major, 102.4, 1e-12);
    EXPECT_NEAR(taps.minor, 1.6, 1e-12);
    EXPECT_NEAR(std::abs(taps.axis.x), 0.1, 1e-15);
}

}  // namespace
}  // namespace opaline::bake
