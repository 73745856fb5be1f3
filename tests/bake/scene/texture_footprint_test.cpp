#include "bake/scene/texture_pyramid.h"

#include <gtest/gtest.h>

#include <cmath>

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

}  // namespace
}  // namespace opaline::bake
