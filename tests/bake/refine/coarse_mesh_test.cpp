#include "bake/refine/coarse_mesh.h"

#include <gtest/gtest.h>

#include <numbers>
#include <set>

#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

DenseMesh dense_mesh(const formats::Primitive& p) {
    DenseMesh mesh{p.position, p.normal, {}};
    for (std::size_t i = 0; i < p.index.size(); i += 3) {
        mesh.triangle.push_back({p.index[i], p.index[i + 1], p.index[i + 2]});
    }
    return mesh;
}

std::vector<CoarseMix> coarsened(const DenseMesh& mesh, double normal_error, float spacing = 1e9f) {
    const std::vector<float> everywhere(mesh.position.size(), spacing);
    return coarsen(mesh, {everywhere, normal_error});
}

std::size_t count_kept(const std::vector<CoarseMix>& mixes) {
    std::size_t kept = 0;
    for (std::uint32_t v = 0; v < mixes.size(); ++v) {
        kept += mixes[v].vertex[0] == v ? 1 : 0;
    }
    return kept;
}

// Summed over a grid of suns, 0.5 degrees apart.
double summed_normal_error(glm::dvec3 normal, const std::array<glm::dvec3, 3>& normals,
                           const std::array<double, 3>& weights) {
    constexpr int kRows = 360;
    const double step = std::numbers::pi / kRows;
    double sum = 0;
    for (int i = 0; i < kRows; ++i) {
        const double theta = (i + 0.5) * step;
        for (int j = 0; j < 2 * kRows; ++j) {
            const double phi = (j + 0.5) * step;
            const glm::dvec3 sun(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi),
                                 std::cos(theta));
            double e = std::max(0.0, glm::dot(normal, sun));
            for (std::size_t k = 0; k < 3; ++k) {
                e -= weights[k] * std::max(0.0, glm::dot(normals[k], sun));
            }
            sum += e * e * std::sin(theta) * step * step;
        }
    }
    return sum / (2 * std::numbers::pi / 3);
}

TEST(NormalError, IsTheSquareOverSunsOfAllDirections) {
    const std::array<glm::vec3, 3> normals{glm::normalize(glm::vec3(0.3f, 0.1f, 1)),
                                           glm::normalize(glm::vec3(-0.2f, 0.4f, 1)),
                                           glm::normalize(glm::vec3(0, -0.5f, 0.7f))};
    const glm::vec3 normal(0, 0, 1);
    const std::array<float, 3> weights{0.5f, 0.3f, 0.2f};
    EXPECT_NEAR(normal_error(normal, normals, weights),
                summed_normal_error(normal, {normals[0], normals[1], normals[2]}, {0.5, 0.3, 0.2}),
                1e-5);
    EXPECT_NEAR(normal_error(normal, {normal, normal, normal}, weights), 0, 1e-7);
    // Against its own opposite: both squares, and nothing in common.
    EXPECT_NEAR(normal_error(normal, {-normal, normal, normal}, {1, 0, 0}), 2, 1e-6);
}

TEST(Coarsen, EveryVertexOfASphereKeepsTheLightOfItsNormalWithinTheBound) {
    const DenseMesh mesh = dense_mesh(tests::make_sphere(5));
    std::size_t before = mesh.position.size();
    for (const double bound : {1e-4, 1e-3, 1e-2}) {
        const std::vector<CoarseMix> mixes = coarsened(mesh, bound);
        const std::size_t kept = count_kept(mixes);
        EXPECT_LT(static_cast<double>(kept), 0.5 * static_cast<double>(before)) << bound;
        before = kept;
        for (std::uint32_t v = 0; v < mixes.size(); ++v) {
            const auto& [u, w] = mixes[v];
            ASSERT_NEAR(w[0] + w[1] + w[2], 1, 1e-5f);
            ASSERT_TRUE(w[0] >= w[1] && w[1] >= w[2] && w[2] >= 0);
            ASSERT_LE(normal_error(mesh.normal[v],
                                   {mesh.normal[u[0]], mesh.normal[u[1]], mesh.normal[u[2]]}, w),
                      1.01 * bound);
            for (const std::uint32_t k : u) {
                ASSERT_EQ(mixes[k].vertex[0], k) << "others are interpolated from it";
            }
        }
    }
}

TEST(Coarsen, NoVertexIsInterpolatedOverMoreThanItsSpacing) {
    const DenseMesh mesh = dense_mesh(tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 40));
    const std::vector<CoarseMix> mixes = coarsened(mesh, 0.1, 0.2f);
    EXPECT_LT(count_kept(mixes), 600u);
    for (const CoarseMix& mix : mixes) {
        for (std::size_t k = 0; k < 3; ++k) {
            ASSERT_LE(
                glm::distance(mesh.position[mix.vertex[k]], mesh.position[mix.vertex[(k + 1) % 3]]),
                0.2f);
        }
    }
}

// Linear light comes back as it was: weights are those of the place.
TEST(Coarsen, PlacesOfAPlaneAreThoseOfTheirMixes) {
    const DenseMesh mesh = dense_mesh(tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 30));
    const std::vector<CoarseMix> mixes = coarsened(mesh, 0.1);
    for (std::uint32_t v = 0; v < mixes.size(); ++v) {
        glm::vec3 at(0);
        for (std::size_t k = 0; k < 3; ++k) {
            at += mixes[v].weight[k] * mesh.position[mixes[v].vertex[k]];
        }
        ASSERT_LT(glm::distance(at, mesh.position[v]), 1e-5f);
    }
}

TEST(Coarsen, BordersAndEdgesOfThreeTrianglesStay) {
    DenseMesh mesh = dense_mesh(tests::make_quad({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, 20));
    std::set<std::uint32_t> held;
    for (std::uint32_t v = 0; v < mesh.position.size(); ++v) {
        const glm::vec3 x = mesh.position[v];
        if (x.x == 0 || x.z == 0 || x.x == 1 || x.z == 1) held.insert(v);
    }
    // A fin on one edge.
    const auto fin = mesh.triangle[300];
    mesh.triangle.push_back({fin[0], fin[1], static_cast<std::uint32_t>(mesh.position.size())});
    mesh.position.emplace_back(0.5f, 1, 0.5f);
    mesh.normal.emplace_back(0, 1, 0);
    held.insert({fin[0], fin[1], mesh.triangle.back()[2]});
    const std::vector<CoarseMix> mixes = coarsened(mesh, 0.1);
    for (const std::uint32_t v : held) {
        EXPECT_EQ(mixes[v].vertex[0], v);
    }
    EXPECT_LT(count_kept(mixes), held.size() + 100);
}

}  // namespace
}  // namespace opaline::bake
