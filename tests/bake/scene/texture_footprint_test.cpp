#include <gtest/gtest.h>

#include <cmath>

#include "bake/scene/sample_image.h"
#include "bake/scene/texture_pyramid.h"

namespace opaline::bake {
namespace {

// Two metres of the texture along x, four along y; slanted in space.
formats::Primitive slanted_triangle() {
    formats::Primitive p;
    const auto at = [](float s, float t) {
        return glm::vec3(1, 2, 3) + s * glm::vec3(0.6f, 0, 0.8f) + t * glm::vec3(0, 1, 0);
    };
    p.position = {at(0, 0), at(3, 1), at(0.5f, 2)};
    p.texcoord = {{0, 0}, {1.5f, 0.25f}, {0.25f, 0.5f}};
    p.index = {0, 1, 2};
    return p;
}

void expect_moments(const UvMoments& found, const UvMoments& expected) {
    EXPECT_NEAR(found.uu, expected.uu, 1e-6);
    EXPECT_NEAR(found.uv, expected.uv, 1e-6);
    EXPECT_NEAR(found.vv, expected.vv, 1e-6);
}

TEST(TextureFootprint, LengthsOnTheSurfaceAreTexturesByTheTrianglesMap) {
    const formats::Primitive p = slanted_triangle();
    const glm::dmat3x2 map = uv_gradient(p, 0);
    const glm::dvec2 along = map * glm::dvec3(0.6, 0, 0.8), up = map * glm::dvec3(0, 1, 0);
    EXPECT_NEAR(along.x, 0.5, 1e-6);
    EXPECT_NEAR(along.y, 0, 1e-6);
    EXPECT_NEAR(up.x, 0, 1e-6);
    EXPECT_NEAR(up.y, 0.25, 1e-6);
    EXPECT_NEAR(glm::length(map * glm::dvec3(0.8, 0, -0.6)), 0, 1e-6) << "out of the plane";
    expect_moments(moments_of_area(map, 0.04), {0.04 * 0.25, 0, 0.04 * 0.0625});
}

TEST(TextureFootprint, WithoutCoordinatesOrAreaItIsAPoint) {
    formats::Primitive p = slanted_triangle();
    p.position[2] = p.position[1];
    EXPECT_EQ(uv_gradient(p, 0), glm::dmat3x2(0.0));
    p = slanted_triangle();
    p.texcoord.clear();
    EXPECT_EQ(uv_gradient(p, 0), glm::dmat3x2(0.0));
}

// A cone of 0.01 sr, 2 m away, at 60 degrees: 0.2 m across, 0.4 m along.
TEST(TextureFootprint, AConeIsStretchedAlongTheRayByTheCosine) {
    const glm::dmat3x2 map{{1, 0}, {0, 1}, {0, 0}};
    const glm::dvec3 slanted{std::sqrt(0.75), 0, -0.5};
    expect_moments(moments_of_cone(map, slanted, {0, 0, 1}, 2, 0.01), {0.16, 0, 0.04});
    expect_moments(moments_of_cone(map, {0, 0, -1}, {0, 0, 1}, 2, 0.01), {0.04, 0, 0.04});
}

// The mean of squares over a triangle is that of its corners' offsets over 12; a box of the
// same second moments has 12 times that.
TEST(TextureFootprint, ATriangleHasItsSecondMoments) {
    const std::array<glm::dvec2, 3> uv{{{0, 0}, {1, 0}, {0, 1}}};
    glm::dvec3 sum(0);
    constexpr int kSteps = 400;
    for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; j + i < kSteps; ++j) {
            const double x = (i + 1.0 / 3) / kSteps - 1.0 / 3, y = (j + 1.0 / 3) / kSteps - 1.0 / 3;
            sum += glm::dvec3(x * x, x * y, y * y);
        }
    }
    const glm::dvec3 mean = sum / (0.5 * kSteps * (kSteps + 1));
    const UvMoments found = moments_of_triangle(uv);
    EXPECT_NEAR(found.uu / (12 * mean.x), 1, 0.01);
    EXPECT_NEAR(found.uv / (12 * mean.y), 1, 0.01);
    EXPECT_NEAR(found.vv / (12 * mean.z), 1, 0.01);
}

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
