#include "bake/exchange/bounce_rays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "bake/exchange/bounce_gather.h"
#include "bake/exchange/scatterers.h"
#include "bake/physics/fresnel.h"
#include "bake/reference/rough_boundary.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kTexels = std::size_t{6} * kBounceCubemap * kBounceCubemap;

// Walls of a medium that sends out nothing of its own.
struct BlackMedium {
    explicit BlackMedium(std::vector<tests::Primitive> walls, float roughness = 0)
        : scene(tests::make_scene(std::move(walls))) {
        scene.materials[0].medium = formats::Medium{};
        scene.materials[0].medium->eta = 1.5f;
        scene.materials[0].medium->roughness = roughness;
        rays = RayScene::build(scene, 1).value();
    }

    // E of a point under radiance 1 where `is_lit`.
    template <class IsLit>
    double irradiance(const Receiver& at, IsLit&& is_lit, std::uint32_t count = 65536) const {
        std::vector<NodeWeight> weights;
        weigh_bounces({scene, rays}, tree, at, make_bounce_grid(count), 1, weights);
        std::vector<float> row(kTexels), light(kTexels);
        add_node_rows(tree, weights, row);
        const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
        for (std::uint32_t t = 0; t < kTexels; ++t) {
            const std::uint32_t own = t % static_cast<std::uint32_t>(face.size());
            const formats::Vec3 d = formats::texel_direction(
                kBounceCubemap, t / static_cast<std::uint32_t>(face.size()), own / kBounceCubemap,
                own % kBounceCubemap);
            light[t] = is_lit(glm::vec3(d.x, d.y, d.z)) ? static_cast<float>(face[own]) : 0;
        }
        formats::haar_forward_cube(std::span<float>(light), kBounceCubemap);
        double sum = 0;
        for (std::size_t t = 0; t < kTexels; ++t) {
            sum += static_cast<double>(row[t]) * static_cast<double>(light[t]);
        }
        return sum;
    }

    formats::Scene scene;
    RayScene rays = RayScene::build({}, 1).value();
    BounceTree tree{{}, 1, kTexels};
};

// A point on a floor before a wall that faces +x. What it receives of the wall stands at +x, and is
//     int F(w.x) w.y dw
// over the quarter of the sphere above the floor and before the wall: more than F_ext of the half
// of the sky that is seen, since rays toward a floor graze.
TEST(MirroredRays, AWallLightsTheFloorFromWhereAMirrorWouldAndMoreAtGrazingAngles) {
    const BlackMedium wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})});
    const Receiver floor{{1e-3f, 0, 0}, {0, 1, 0}};
    double expected = 0;
    constexpr int kParts = 400;
    for (int i = 0; i < kParts; ++i) {
        for (int j = 0; j < kParts; ++j) {
            const double up = (i + 0.5) / kParts;
            const double azimuth = std::numbers::pi * (j + 0.5) / kParts;
            expected += std::numbers::pi / (kParts * kParts) * up *
                        fresnel_reflectance(std::sqrt(1 - up * up) * std::sin(azimuth), 1.5);
        }
    }
    const auto before = [](glm::vec3 d) { return d.x > 0 && d.y > 0; };
    const auto elsewhere = [&](glm::vec3 d) { return !before(d); };
    EXPECT_NEAR(wall.irradiance(floor, before), expected, 0.01 * expected);
    EXPECT_NEAR(wall.irradiance(floor, elsewhere), 0, 1e-3 * expected);
    EXPECT_GT(expected, 1.3 * 0.0918 * std::numbers::pi / 2);
}

// The lobe of a rough boundary as path tracing has it: what a point before a wall receives of light
// from one half of the sky is int int f(o, l) l.n (o.y) dl do over that half and the rays o.
TEST(MirroredRays, ARoughWallMirrorsLessAtGrazingAnglesAndAroundTheMirrorsDirection) {
    constexpr float kRoughness = 0.6f;
    const BlackMedium wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})}, kRoughness);
    const Receiver floor{{1e-3f, 0, 0}, {0, 1, 0}};
    constexpr int kParts = 56;
    const auto sphere = [](int i, int j) {
        const float up = 2 * (static_cast<float>(i) + 0.5f) / kParts - 1;
        const float azimuth =
            std::numbers::pi_v<float> * ((static_cast<float>(j) + 0.5f) / kParts - 0.5f);
        const float across = std::sqrt(1 - up * up);
        return glm::vec3(across * std::cos(azimuth), up, across * std::sin(azimuth));
    };
    constexpr double kSolid = 2 * std::numbers::pi / (kParts * kParts);
    double up = 0, down = 0;  // light of the sky above and below the horizon, x > 0
    for (int i = kParts / 2; i < kParts; ++i) {
        for (int j = 0; j < kParts; ++j) {
            // Rays go toward the wall, along -x: the eye is where they come from.
            const glm::vec3 ray = sphere(i, j) * glm::vec3(-1, 1, 1);
            const RoughBoundary boundary =
                make_rough_boundary({1, 0, 0}, -ray, kRoughness * kRoughness, 1.5f);
            for (int k = 0; k < kParts; ++k) {
                for (int l = 0; l < kParts; ++l) {
                    const glm::vec3 to_light = sphere(k, l);
                    (to_light.y > 0 ? up : down) +=
                        kSolid * kSolid * static_cast<double>(ray.y) *
                        static_cast<double>(eval_rough_boundary(boundary, to_light).response);
                }
            }
        }
    }
    EXPECT_GT(down, 0.02 * up);
    const double from_above =
        wall.irradiance(floor, [](glm::vec3 d) { return d.x > 0 && d.y > 0; });
    const double from_below =
        wall.irradiance(floor, [](glm::vec3 d) { return d.x > 0 && d.y < 0; });
    EXPECT_NEAR(from_above, up, 0.02 * up);
    EXPECT_NEAR(from_below, down, 0.08 * down);
    const double smooth = BlackMedium({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})})
                              .irradiance(floor, [](glm::vec3) { return true; });
    EXPECT_LT(from_above + from_below, 0.9 * smooth);
}

// Light of a point's rays that meet walls, over their share: what the walls send out of even light,
// 1 - F_ext, and the sky in them. One point answers for a wall.
double sum_of_shares(const BlackMedium& walls, const Receiver& at, std::uint32_t rays,
                     bool is_closed) {
    std::vector<Scatterer> scatterers;
    for (int i = 0; i < 6; ++i) {
        Scatterer s;
        s.normal[i % 3] = i < 3 ? 1.0f : -1.0f;
        s.position = -s.normal;
        scatterers.push_back(s);
    }
    if (!is_closed) {
        scatterers = {scatterers.front()};
    }
    const BounceTree tree(scatterers, 1, kTexels);
    std::vector<NodeWeight> weights;
    const BounceGather gathered =
        weigh_bounces({walls.scene, walls.rays}, tree, at, make_bounce_grid(rays), 1, weights);
    const double left = 1 - fresnel_moments(double{walls.scene.materials[0].medium->eta}).external;
    double sum = 0;
    for (const NodeWeight& w : weights) {
        sum += double{w.weight} * (w.node < tree.size() ? left : 1);
    }
    return sum / double{gathered.met};
}

// Also where a texel of the sky would be too bright for a mirror, and after the last of many
// mirrors.
TEST(MirroredRays, WhatAMediumMirrorsAndWhatItSendsAddUpToTheLightOfARay) {
    for (const float eta : {1.1f, 1.5f, 2.5f, 0.8f}) {
        for (const float roughness : {0.0f, 0.5f}) {
            BlackMedium box({tests::make_cube(1, true)}, roughness);
            BlackMedium wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80})}, roughness);
            box.scene.materials[0].medium->eta = wall.scene.materials[0].medium->eta = eta;
            for (const std::uint32_t rays : {16u, 64u, 1024u}) {
                EXPECT_NEAR(sum_of_shares(box, {{0.3f, -0.99f, 0.2f}, {0, 1, 0}}, rays, true), 1,
                            1e-4)
                    << eta << " " << roughness << " " << rays;
                EXPECT_NEAR(sum_of_shares(wall, {{1e-3f, 0, 0}, {0, 1, 0}}, rays, false), 1, 1e-4)
                    << eta << " " << roughness << " " << rays;
            }
        }
    }
}

// In a corner a ray comes back the way it came, less by both reflectances.
TEST(MirroredRays, TwoWallsOfACornerMirrorOneAfterTheOther) {
    const BlackMedium corner({tests::make_quad({0, 0, -1}, {0, 0, 2}, {2, 0, 0}),
                              tests::make_quad({0, 0, -1}, {0, 2, 0}, {0, 0, 2})});
    const glm::vec3 way = glm::normalize(glm::vec3(-0.6f, -0.5f, 0.1f));
    const MirroredRay first{{0.5f, 0.2f, 0}, way, {1, 1, 1}, 7};
    std::vector<MirroredNode> found;
    EXPECT_EQ(follow_mirrored({corner.scene, corner.rays}, corner.tree, {first}, found), 3u);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].node, corner.tree.sky_node({-way.x, -way.y, way.z}));
    EXPECT_EQ(found[0].number, 7u);
    EXPECT_NEAR(found[0].share.g,
                fresnel_reflectance(static_cast<double>(-way.x), 1.5) *
                    fresnel_reflectance(static_cast<double>(-way.y), 1.5),
                1e-6);
}

// Floor beside a ball, under a small light. What the ball mirrors of it varies smoothly over the
// floor: a convex mirror spreads light. With a single ray in each of 64 cells, points found the
// light by chance, and their error was .059 of what they receive of it directly: specks.
TEST(MirroredRays, ABallThatMirrorsTheSunLeavesNoSpecksOnTheFloor) {
    const BlackMedium ball({tests::make_sphere(4, 1, {0, 1, 0})});
    const glm::vec3 sun = glm::normalize(glm::vec3(1, 0.9f, 0.4f));
    const auto is_lit = [&](glm::vec3 d) { return glm::dot(d, sun) > 0.99f; };
    const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
    const double direct = face[0] * double{sun.y};
    double sum = 0, expected_sum = 0, square = 0;
    constexpr int kPoints = 10;
    for (int i = 0; i < kPoints; ++i) {
        for (int j = 0; j < kPoints; ++j) {
            const Receiver floor{
                {1 + 0.1f * static_cast<float>(i), 0, 0.13f * static_cast<float>(j)}, {0, 1, 0}};
            const double expected = ball.irradiance(floor, is_lit, 16384);
            const double found = ball.irradiance(floor, is_lit, 64);
            sum += found;
            expected_sum += expected;
            square += (found - expected) * (found - expected);
        }
    }
    constexpr int kAll = kPoints * kPoints;
    EXPECT_LT(std::sqrt(square / kAll), 0.03 * direct);
    EXPECT_NEAR(sum, expected_sum, 0.1 * expected_sum);
}

// Few rays cannot make a texel brighter than a flat mirror shows it: its share of the hemisphere
// is at most its solid angle over pi. One of 16 rays that grazes a wall had 6.8 times that.
TEST(MirroredRays, NoTexelIsBrighterInABoundaryThanInAFlatMirror) {
    const BlackMedium wall({tests::make_quad({0, -40, -40}, {0, 80, 0}, {0, 0, 80}, 1)});
    const std::vector<double> face = formats::texel_solid_angles(kBounceCubemap);
    double most = 0;
    std::vector<NodeWeight> weights;
    for (int i = 0; i < 200; ++i) {
        const Receiver floor{{0.01f * static_cast<float>(1 + i), 0, 0}, {0, 1, 0}};
        weigh_bounces({wall.scene, wall.rays}, wall.tree, floor, make_bounce_grid(16), 1, weights);
        for (const NodeWeight& w : weights) {
            const double flat = face[w.node % face.size()] / std::numbers::pi;
            most = std::max(most, double{w.weight} / flat);
        }
    }
    EXPECT_LE(most, 1.000001);
    EXPECT_GT(most, 0.2);
}

TEST(MirroredRays, OpaqueSurfacesAndIndexMatchedMediaMirrorNothingHere) {
    BlackMedium plate({tests::make_quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0})});
    const RayEnd end{.direction = {0, -1, 0}, .side = {true, false, {0, 1, 0}, 1}};
    EXPECT_NEAR(mirror({plate.scene, plate.rays}, end, {1, 1, 1}, 0).share.g, 0.04, 1e-6);
    plate.scene.materials[0].medium->eta = 1;
    EXPECT_EQ(mirror({plate.scene, plate.rays}, end, {1, 1, 1}, 0).largest(), 0);
    plate.scene.materials[0].medium.reset();
    EXPECT_EQ(mirror({plate.scene, plate.rays}, end, {1, 1, 1}, 0).largest(), 0);
}

}  // namespace
}  // namespace opaline::bake
