#include "formats/opal/cubemap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/reference_table.h"

namespace opaline::formats {
namespace {

// The OpenGL specification's table: major axis, and the axes that s and t run along.
TEST(Cubemap, FacesAreOrientedAsInOpenGL) {
    struct Row {
        Vec3 centre, along_s, along_t;
    };
    const Row table[6] = {
        {{1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
        {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},   {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
        {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}};
    for (std::uint32_t face = 0; face < 6; ++face) {
        const Vec3 p = cube_position({face, 0.25f, 0.5f});
        const Vec3 expected =
            table[face].centre + 0.25f * table[face].along_s + 0.5f * table[face].along_t;
        EXPECT_EQ(p, expected) << "face " << face;
    }
}

TEST(Cubemap, EveryTexelCentreFallsIntoItsOwnTexel) {
    for (const std::uint32_t n : {8u, 16u, 128u}) {
        for (std::uint32_t index = 0; index < cubemap_texels(n); ++index) {
            const Vec3 d = texel_direction(n, index / (n * n), index / n % n, index % n);
            ASSERT_EQ(texel_index(n, d), index);
            ASSERT_NEAR(length(d), 1.0f, 1e-6f);
        }
    }
}

TEST(Cubemap, SolidAnglesMatchTheReference) {
    OPALINE_REFERENCE_ROWS(rows, "translucency.csv", "texel_solid_angle");
    for (const auto& row : rows) {
        const auto n = static_cast<std::uint32_t>(row.number("n"));
        const auto i = static_cast<std::uint32_t>(row.number("i"));
        const auto j = static_cast<std::uint32_t>(row.number("j"));
        EXPECT_NEAR(texel_solid_angles(n)[i * n + j], row.expected, row.tolerance()) << row.name();
    }
}

// The moment of a hemisphere about its axis is the cosine's integral, pi; of the sphere, zero.
TEST(Cubemap, TexelMomentsIntegrateTheCosine) {
    for (const std::uint32_t n : {8u, 64u}) {
        const std::vector<Vec3> moments = texel_moments(n);
        double upper = 0, x = 0, y = 0, z = 0;
        for (const Vec3 m : moments) {
            upper += m.y > 0 ? static_cast<double>(m.y) : 0.0;
            x += static_cast<double>(m.x), y += static_cast<double>(m.y);
            z += static_cast<double>(m.z);
        }
        EXPECT_NEAR(upper, std::numbers::pi, 1e-6) << n;
        EXPECT_NEAR(std::hypot(x, y, z), 0.0, 1e-6) << n;
    }
}

// For a small texel the moment tends to its solid angle times its direction.
TEST(Cubemap, TexelMomentsPointThroughTheirTexels) {
    const std::uint32_t n = 64;
    const std::vector<Vec3> moments = texel_moments(n);
    const std::vector<double> solid_angle = texel_solid_angles(n);
    for (std::uint32_t index = 0; index < cubemap_texels(n); ++index) {
        const Vec3 d = texel_direction(n, index / (n * n), index / n % n, index % n);
        const auto omega = static_cast<float>(solid_angle[index % (n * n)]);
        ASSERT_LT(length(moments[index] - omega * d), 1e-3f * omega) << index;
    }
}

}  // namespace
}  // namespace opaline::formats
