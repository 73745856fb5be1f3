#include <gtest/gtest.h>

#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "tests/bake/visibility/white_sky.h"
#include "tests/support/scenes.h"

namespace opaline::bake {
namespace {

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

}  // namespace
}  // namespace opaline::bake
