#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "bake/receivers/kd_order.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/trace/irradiance_transport.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/cubemap.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

// Rays of one direction from points in a small part of a body, some of them from behind the first
// surface, as for undecided look-ups of a light map.
TEST(RayPackets, MeetTheNearestTriangleBeyondTheirStart) {
    const auto scene = tests::make_scene({tests::make_sphere(2, 1), tests::make_sphere(2, 0.9f)});
    const RayScene rays = tests::build_rays(scene);
    std::mt19937 generator(5);
    std::normal_distribution<float> normal;
    const auto random = [&] {
        return glm::vec3(normal(generator), normal(generator), normal(generator));
    };
    int met = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const glm::vec3 direction = glm::normalize(random());
        const glm::vec3 centre = 0.94f * glm::normalize(random());
        RayPacket packet{};
        packet.mask.fill(0xffffffffu);
        packet.dir_x.fill(direction.x);
        packet.dir_y.fill(direction.y);
        packet.dir_z.fill(direction.z);
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        LaneMask lanes;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const glm::vec3 origin = centre + 0.02f * random();
            packet.org_x[lane] = origin.x;
            packet.org_y[lane] = origin.y;
            packet.org_z[lane] = origin.z;
            packet.tnear[lane] = lane % 2 == 0 ? 0.0f : 0.2f;
            lanes[lane] = lane < 11 ? -1 : 0;
        }
        const PacketHits hits = rays.closest(lanes, packet);
        for (std::uint32_t lane = 0; lane < 11; ++lane) {
            const glm::dvec3 origin(packet.org_x[lane], packet.org_y[lane], packet.org_z[lane]);
            const double nearest =
                tests::brute_force_distance(scene, origin, direction, packet.tnear[lane]);
            ASSERT_EQ(hits.hit[lane] != 0, std::isfinite(nearest)) << trial << ' ' << lane;
            if (std::isfinite(nearest)) {
                EXPECT_NEAR(hits.distance[lane], nearest, 1e-4) << trial << ' ' << lane;
                ++met;
            }
        }
    }
    EXPECT_GT(met, 1000);
}

using tests::build_rays;
using tests::gather_texels;
using tests::white_irradiance;

struct Placement {
    const char* name;
    float scale;
    glm::vec3 offset;
};
const Placement kPlacements[] = {{"at the origin", 1, {0, 0, 0}},
                                 {"tiny", 1e-5f, {0, 0, 0}},
                                 {"huge", 1e6f, {0, 0, 0}},
                                 {"far away", 1, {1000, -2000, 500}},
                                 {"tiny and off centre", 1e-3f, {1, 2, -3}}};

// Nothing blocks a convex body's own hemispheres: each vertex must see exactly what it would see if
// the body were not there. One false hit makes a texel differ.
TEST(SelfIntersection, ConvexBodiesNeverShadowThemselves) {
    const RayScene nothing = build_rays(tests::make_scene({}));
    for (const Placement& place : kPlacements) {
        for (const auto& body : {tests::make_sphere(4), tests::make_cube(5, false)}) {
            const auto scene = tests::make_scene(
                {tests::transformed(body, tests::some_rotation(), place.scale, place.offset)});
            const RayScene rays = build_rays(scene);
            for (const Receiver& receiver : make_vertex_receivers(scene)) {
                ASSERT_EQ(gather_texels(rays, receiver, 8), gather_texels(nothing, receiver, 8))
                    << body.name << ' ' << place.name;
            }
        }
    }
}

// Inside a closed room it is dark, in its corners and along its edges too.
TEST(SelfIntersection, ClosedRoomsLeakNoLight) {
    for (const Placement& place : kPlacements) {
        const auto scene = tests::make_scene({tests::transformed(
            tests::make_cube(6, true), tests::some_rotation(), place.scale, place.offset)});
        const RayScene rays = build_rays(scene);
        for (const Receiver& receiver : make_vertex_receivers(scene)) {
            for (const float value : gather_texels(rays, receiver, 8)) {
                ASSERT_EQ(value, 0.0f) << place.name;
            }
        }
    }
}

// Exporters split vertices where texture coordinates jump: what they gather must not differ.
TEST(SelfIntersection, DuplicatedVerticesGatherTheSame) {
    auto sphere = tests::make_sphere(2, 1, {0, 1, 0});
    const auto first = static_cast<std::uint32_t>(sphere.position.size());
    sphere.position.push_back(sphere.position[20]);
    sphere.normal.push_back(sphere.normal[20]);
    bool replaced = false;
    for (std::uint32_t& i : sphere.index) {
        if (i == 20 && !replaced) {
            i = first;
            replaced = true;
        }
    }
    ASSERT_TRUE(replaced);
    const auto scene =
        tests::make_scene({sphere, tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 4)});
    const auto receivers = make_vertex_receivers(scene);
    EXPECT_EQ(receivers[20].origin, receivers[first].origin);
    EXPECT_EQ(receivers[20].normal, receivers[first].normal);
}

// Smooth normals on a coarse body: the facet's own plane would cut off the terminator.
TEST(SelfIntersection, SamplesOfACoarseSmoothSphereSeeTheTerminatorOfTheSphere) {
    const auto scene = tests::make_scene({tests::make_sphere(1)});
    const RayScene rays = build_rays(scene);
    double lifted = 0, on_facet = 0;
    const auto samples = sample_surface(scene, {0}, 200, 1, {});
    for (const SurfaceSample& sample : samples) {
        lifted += white_irradiance(rays, sample.receiver, 16) / 200;
        on_facet +=
            white_irradiance(
                rays, {sample.position + 1e-5f * sample.geometric_normal, sample.normal}, 16) /
            200;
    }
    EXPECT_GT(lifted, 0.999);
    EXPECT_LT(on_facet, 0.998);  // the lift prevents this
}

constexpr std::uint32_t kSize = 16;

struct Gathered {
    std::vector<float> own, shared;  // dense transport of all samples
    std::uint64_t own_rays = 0, shared_rays = 0;
    std::size_t samples = 0;
};

Gathered gather_both(const formats::Scene& scene, std::uint32_t count) {
    const auto rays = RayScene::build(scene, 1);
    const auto samples = sample_surface(scene, {0}, count, 1, {});
    const SharedDirections directions = make_shared_directions(kSize);
    const std::size_t texels = formats::cubemap_texels(kSize);
    Gathered both;
    both.samples = samples.size();
    both.own.resize(samples.size() * texels);
    both.shared.resize(samples.size() * texels);
    for (std::size_t s = 0; s < samples.size(); s += kSamplesPerGroup) {
        std::vector<Receiver> group;
        for (std::size_t i = s; i < std::min(samples.size(), s + kSamplesPerGroup); ++i) {
            both.own_rays +=
                gather_irradiance(*rays, directions.sets[(i - s) % 4], samples[i].receiver,
                                  std::span(both.own).subspan(i * texels, texels));
            group.push_back(samples[i].receiver);
        }
        both.shared_rays += gather_irradiance_together(
            *rays, directions, group,
            std::span(both.shared).subspan(s * texels, group.size() * texels));
    }
    return both;
}

double sum(const std::vector<float>& values) {
    double total = 0;
    for (const float value : values) {
        total += static_cast<double>(value);
    }
    return total;
}

TEST(SharedRays, ConvexBodiesSeeWhatTheySeeAlone) {
    const Gathered ball = gather_both(tests::make_scene({tests::make_sphere(3)}), 640);
    EXPECT_EQ(ball.own, ball.shared);
    EXPECT_LT(ball.shared_rays, ball.own_rays / 12);
}

TEST(SharedRays, FloorUnderABallKeepsItsShadow) {
    tests::Primitive ball = tests::make_sphere(3);
    for (glm::vec3& p : ball.position) {
        p.y += 1.5f;
    }
    const Gathered floor = gather_both(
        tests::make_scene({tests::make_quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, 8), ball}), 4000);
    double wrong = 0, all = 0;
    for (std::size_t k = 0; k < floor.own.size(); ++k) {
        wrong += std::pow(static_cast<double>(floor.own[k] - floor.shared[k]), 2);
        all += std::pow(static_cast<double>(floor.own[k]), 2);
    }
    EXPECT_LT(std::sqrt(wrong / all), 0.02);
    EXPECT_NEAR(sum(floor.shared) / sum(floor.own), 1, 2e-4);
    EXPECT_LT(floor.shared_rays, floor.own_rays / 2);
}

// Bars a quarter of a texel wide, five texels apart: a coarse grid of rays would miss most of them.
TEST(SharedRays, NarrowBarsCastTheirShadow) {
    std::vector<tests::Primitive> parts{
        tests::make_quad({-0.5f, 0, -0.5f}, {0, 0, 1}, {1, 0, 0}, 4)};
    for (int i = -3; i <= 3; ++i) {
        const float x = static_cast<float>(i) * 0.6f;
        parts.push_back(tests::make_quad({x - 0.015f, 1, -3}, {0, 0, 6}, {0.03f, 0, 0}, 1));
    }
    const Gathered open = gather_both(tests::make_scene({parts.front()}), 640);
    const Gathered barred = gather_both(tests::make_scene(parts), 640);
    const double shadow = sum(open.own) - sum(barred.own);
    ASSERT_GT(shadow, 0.02 * sum(open.own));
    EXPECT_NEAR((sum(open.shared) - sum(barred.shared)) / shadow, 1, 0.1);
}

TEST(SharedRays, BlocksBorderOnEachOther) {
    for (const std::uint32_t n : {8u, 32u}) {
        const auto beside = make_shared_directions(n).beside;
        std::size_t one_sided = 0, lonely = 0;
        for (std::uint32_t a = 0; a < beside.size(); ++a) {
            lonely += beside[a].size() < 4 ? 1 : 0;
            for (const std::uint32_t b : beside[a]) {
                one_sided += std::count(beside[b].begin(), beside[b].end(), a) == 1 ? 0 : 1;
            }
        }
        EXPECT_EQ(lonely, 0u) << n;
        EXPECT_EQ(one_sided, 0u) << n;
    }
}

}  // namespace

}  // namespace opaline::bake
