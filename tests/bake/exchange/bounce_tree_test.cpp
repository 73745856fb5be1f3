#include "bake/exchange/bounce_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

#include "bake/base/rng.h"
#include "bake/exchange/scatterers.h"

namespace opaline::bake {
namespace {

// Points of the unit square of the floor, seen from above, and below it from below.
std::vector<Scatterer> both_sides(std::uint32_t count) {
    std::vector<Scatterer> all;
    for (std::uint32_t i = 0; i < count; ++i) {
        const auto u = random_uniform(3, RandomStage::bounce_rays, i);
        Scatterer s;
        s.behind = i % 2 == 1;
        s.position = {u[0], s.behind ? -1e-3f : 0, u[1]};
        s.normal = {0, s.behind ? -1.0f : 1.0f, 0};
        all.push_back(s);
    }
    return all;
}

// The row of a scatterer: its place, and 1 behind.
std::vector<float> rows_of(const std::vector<Scatterer>& all) {
    std::vector<float> rows;
    for (const Scatterer& s : all) {
        rows.insert(rows.end(), {s.position.x, s.position.z, s.behind ? 1.0f : 0.0f});
    }
    return rows;
}

BounceTree tree_of(const std::vector<Scatterer>& all) {
    BounceTree tree(all, 1, 3);
    tree.set_rows({rows_of(all), 3});
    return tree;
}

TEST(BounceTree, SidesOfAThinPlateDoNotMix) {
    const BounceTree tree = tree_of(both_sides(256));
    for (std::uint32_t i = 0; i < 64; ++i) {
        const auto u = random_uniform(4, RandomStage::bounce_rays, i);
        for (const bool behind : {false, true}) {
            const glm::vec3 normal{0, behind ? -1 : 1, 0};
            const auto node = tree.find({u[0], 0, u[1]}, {0, behind, normal}, u[2]);
            EXPECT_EQ(tree.rows().row(node)[2], behind ? 1 : 0);
        }
    }
}

TEST(BounceTree, TheFootprintOfNothingFindsANeighbourAndThatOfAllTheMean) {
    const BounceTree tree = tree_of(both_sides(2048));
    const auto root = tree.find({0.2f, 0, 0.7f}, {0, false, {0, 1, 0}}, 4);
    EXPECT_NEAR(tree.rows().row(root)[0], 0.5, 0.005) << "of the square, not of its points";
    EXPECT_NEAR(tree.rows().row(root)[1], 0.5, 0.005);
    const auto leaf = tree.find({0.2f, 0, 0.7f}, {0, false, {0, 1, 0}}, 0);
    EXPECT_NEAR(tree.rows().row(leaf)[0], 0.2, 0.1);
    EXPECT_NEAR(tree.rows().row(leaf)[1], 0.7, 0.1);
}

// A footprint narrower than the gaps between scatterers, and long: nodes are scatterers.
TEST(BounceTree, ALongFootprintFindsEveryScattererUnderIt) {
    constexpr float kWide = 0.4f, kNarrow = 0.005f;
    std::vector<Scatterer> all(1024);
    for (std::uint32_t i = 0; i < 1024; ++i) {
        const auto u = random_uniform(6, RandomStage::bounce_rays, i);
        all[i].position = {(static_cast<float>(i % 32) + 0.5f * u[0]) / 32, 0,
                           (std::floor(static_cast<float>(i) / 32) + 0.5f * u[1]) / 32};
        all[i].normal = {0, 1, 0};
    }
    const BounceTree tree = tree_of(all);
    std::size_t found_in_all = 0;
    for (std::uint32_t k = 0; k < 64; ++k) {
        const auto u = random_uniform(5, RandomStage::bounce_rays, k);
        const float turn = 6.2831853f * u[2];
        const glm::vec3 across{std::cos(turn), 0, std::sin(turn)}, up{0, 1, 0};
        const glm::vec3 along = glm::cross(across, up);
        const float height = std::sqrt(kWide * kNarrow);
        FootprintKernel kernel;
        kernel.centre = {u[0], 0, u[1]};
        kernel.across = across / kWide;
        kernel.along = along / kNarrow;
        kernel.above = up / height;
        kernel.extent = glm::sqrt(kWide * across * kWide * across +
                                  kNarrow * along * kNarrow * along + height * up * height * up);
        kernel.steepest = 1 / kNarrow;
        kernel.area = kWide * kNarrow;
        std::vector<float> expected, found;
        for (const Scatterer& s : all) {
            const glm::vec3 offset = s.position - kernel.centre;
            const float x = glm::dot(offset, kernel.across), y = glm::dot(offset, kernel.along);
            if (x * x + y * y < 0.75f) {
                expected.push_back(s.position.x);
            }
        }
        tree.find_near(kernel, {0, false, up}, brightness_of(0),
                       [&](std::uint32_t node, float, glm::vec2) {
                           found.push_back(tree.rows().row(node)[0]);
                       });
        std::ranges::sort(expected);
        std::ranges::sort(found);
        ASSERT_EQ(found.size(), expected.size()) << k;
        for (std::size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i], expected[i], 1e-4f) << k;
        }
        found_in_all += found.size();
    }
    EXPECT_GT(found_in_all, 100u);
}

// Means over a footprint lie closer to its middle the smaller it is.
TEST(BounceTree, NodesAreAsLargeAsTheFootprint) {
    const BounceTree tree = tree_of(both_sides(4096));
    for (const float footprint : {0.25f, 0.0625f, 0.015625f}) {
        double squares = 0;
        for (std::uint32_t i = 0; i < 256; ++i) {
            const auto u = random_uniform(5, RandomStage::bounce_rays, i);
            const auto node = tree.find({u[0], 0, u[1]}, {0, false, {0, 1, 0}}, footprint);
            const double dx = tree.rows().row(node)[0] - u[0], dz = tree.rows().row(node)[1] - u[1];
            squares += (dx * dx + dz * dz) / 256;
        }
        // A square of area a has a mean squared distance of a / 6; nodes have a / 4 to a.
        EXPECT_LT(squares, 0.25 * footprint);
        EXPECT_GT(squares, footprint / 40);
    }
}

// Cubes side by side, and soups of triangles an ulp apart: the tree ends, with every scatterer in
// it.
TEST(BounceTree, ScatterersAtOnePlaceOrAnUlpApartEachHaveALeaf) {
    const float next = std::nextafter(1.0f, 2.0f);
    std::vector<std::vector<float>> places;
    places.emplace_back(100, 1.0f);
    places.emplace_back(100, 1.0f).back() = next;
    places.emplace_back(100, next).front() = 1.0f;
    places.emplace_back(100, -1.0f).back() = -std::nextafter(1.0f, 0.0f);
    places.emplace_back(100, 0.0f).back() = std::numeric_limits<float>::denorm_min();
    places.emplace_back(2000, 0.0f);
    for (int k = 0; k < 250; ++k) {
        places.back()[static_cast<std::size_t>(k)] = std::ldexp(1.0f, 100 - k);
    }
    for (const std::vector<float>& along : places) {
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            std::vector<Scatterer> all(along.size());
            for (std::size_t i = 0; i < all.size(); ++i) {
                all[i].position = glm::vec3(1);
                all[i].position[axis] = along[i];
                all[i].normal = {0, 1, 0};
            }
            const BounceTree tree(all, 1, 3);
            EXPECT_EQ(tree.size(), 2 * all.size() - 1);
            std::vector<std::uint32_t> leaves = tree.neighbours(), each(all.size());
            std::iota(each.begin(), each.end(), 0u);
            std::ranges::sort(leaves);
            EXPECT_EQ(leaves, each) << axis;
            EXPECT_LT(tree.find({1, 1, 1}, {0, false, {0, 1, 0}}, 0), tree.size());
        }
    }
}

// A room's back wall, and the front of a box that stands before it, of one material. The middle of
// all places along z lies on the wall, where rounding errors would decide.
TEST(BounceTree, ParallelWallsDoNotMix) {
    std::vector<Scatterer> all;
    for (std::uint32_t i = 0; i < 2048; ++i) {
        const auto u = random_uniform(3, RandomStage::bounce_rays, i);
        Scatterer s;
        const bool is_near = i % 8 == 0;
        s.position = is_near ? glm::vec3(0.2f + 0.1f * u[0], 0.1f * u[1], 2)
                             : glm::vec3(u[0], u[1], 1e-8f * (u[2] - 0.5f));
        s.normal = {0, 0, 1};
        all.push_back(s);
    }
    BounceTree tree(all, 1, 3);
    std::vector<float> rows;
    for (const Scatterer& s : all) {
        rows.insert(rows.end(), {s.position.x, s.position.y, s.position.z});
    }
    tree.set_rows({rows, 3});
    for (std::uint32_t i = 0; i < 256; ++i) {
        const auto u = random_uniform(4, RandomStage::bounce_rays, i);
        const glm::vec3 y{u[0], u[1], 1e-8f * (u[2] - 0.5f)};
        const auto row = tree.rows().row(tree.find(y, {0, false, {0, 0, 1}}, 0));
        EXPECT_NEAR(row[0], y.x, 0.1);
        EXPECT_NEAR(row[1], y.y, 0.1);
        EXPECT_NEAR(row[2], 0, 1e-6);
    }
}

// Means weigh places as they cover the surface, however many scatterers lie there: here nine of ten
// in a hundredth of it.
TEST(BounceTree, MeansAreOverTheSurface) {
    std::vector<Scatterer> all;
    std::vector<float> rows;
    for (std::uint32_t i = 0; i < 4096; ++i) {
        const auto u = random_uniform(3, RandomStage::bounce_rays, i);
        const float scale = i % 10 == 0 ? 1.0f : 0.1f;
        Scatterer s;
        s.position = {scale * u[0], 0, scale * u[1]};
        s.normal = {0, 1, 0};
        all.push_back(s);
        rows.push_back(s.position.x);
    }
    BounceTree tree(all, 1, 1);
    tree.set_rows({rows, 1});
    EXPECT_NEAR(tree.rows().row(tree.find({0.5f, 0, 0.5f}, {0, false, {0, 1, 0}}, 4))[0], 0.5,
                0.02);
}

TEST(BounceTree, SurfacesWithoutScatterersAnswerNothing) {
    const auto all = both_sides(16);
    const BounceTree tree(all, 2, 3);
    EXPECT_EQ(tree.find({0, 0, 0}, {1, false, {0, 1, 0}}, 0), formats::kNone);
    // Another facing of the same side: the nearest there is.
    EXPECT_NE(tree.find({0, 0, 0}, {0, false, {1, 0, 0}}, 0), formats::kNone);
}

}  // namespace
}  // namespace opaline::bake
