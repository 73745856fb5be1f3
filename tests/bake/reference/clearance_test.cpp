#include <gtest/gtest.h>

#include <algorithm>

#include "bake/trace/clearance_grid.h"
#include "tests/bake/reference/reference_support.h"

namespace opaline::tests {
namespace {

// Of the whole scene.
bake::ClearanceGrid around(const bake::HitScene& surfaces, float cell) {
    return {surfaces.scene(), surfaces.centre(), surfaces.half_size(), cell};
}

// The bound is valid: no ray hits anything within it, for any position of triangles in the grid.
TEST(ReferenceClearance, NoRayMeetsASurfaceWithinIt) {
    const auto bodies =
        make_fixture(make_scene({make_sphere(2), make_sphere(1, 0.3f, {0.4f, 0, 0}),
                                 make_quad({-1, -0.8f, -1}, {0, 0, 2}, {2, 0.3f, 0}, 3)}),
                     make_white_sky());
    const bake::HitScene& surfaces = bodies->scene.surfaces;
    bake::RandomStream random(0, 0, 0);
    const auto next = [&] { return 2 * random.next() - 1; };
    for (const float cell : {0.013f, 0.05f, 0.2f}) {
        const bake::ClearanceGrid clearance = around(surfaces, cell);
        double known = 0, true_distance = 0;
        for (int i = 0; i < 300; ++i) {
            const glm::vec3 point(next(), next(), next());
            float nearest = 10;
            for (int k = 0; k < 300; ++k) {
                const glm::vec3 direction = glm::normalize(glm::vec3(next(), next(), next()));
                if (const auto hit = surfaces.closest_hit({point}, direction, 10)) {
                    nearest = std::min(nearest, hit->distance);
                }
            }
            EXPECT_GE(nearest, clearance(point)) << cell;
            known += static_cast<double>(clearance(point));
            true_distance += static_cast<double>(nearest);
        }
        // The bound is not uselessly small.
        if (cell < 0.1f) {
            EXPECT_GT(known, 0.3 * true_distance) << cell;
        }
    }
}

// Each triangle spans the whole grid. Marking the cells of all would take minutes, and hours for
// 100 000 triangles.
TEST(ReferenceClearance, NothingIsKnownOfASoupOfTrianglesAsLargeAsTheScene) {
    std::vector<Primitive> sheets;
    for (int i = 0; i < 100; ++i) {
        const float lean = 0.01f * static_cast<float>(i);
        sheets.push_back(make_quad({-1, -1, -1}, {2, 0, 2 - lean}, {0, 2, lean}, 1));
    }
    const auto soup = make_fixture(make_scene(sheets), make_white_sky());
    const bake::ClearanceGrid clearance = around(soup->scene.surfaces, 0.016f);
    for (const float x : {-0.9f, -0.5f, 0.0f, 0.5f, 0.9f}) {
        EXPECT_EQ(clearance({x, 0, -x}), 0);
    }
    const bake::ClearanceGrid coarse = around(soup->scene.surfaces, 0.2f);
    EXPECT_GT(coarse({0.9f, 0, -0.9f}), 0);
}

// Skipped rays change no walk: a trivial grid gives the same numbers.
TEST(ReferenceClearance, WalksAreTheSameBitByBit) {
    Scene input = make_scene({make_sphere(3)});
    input.materials[0].medium = make_medium(30, 0.98f, 0.3f, 1.4f);
    const auto body = make_fixture(std::move(input), make_half_sky(true));
    ASSERT_GT(body->scene.clearance({0, 0, 0}), 0.5f);
    const auto trace = [&] {
        std::vector<float> found;
        for (std::uint32_t i = 0; i < 5000; ++i) {
            bake::RandomStream random(1, 0, i);
            found.push_back(
                bake::trace_ray(body->space(), {0.1f, 2, 0.2f}, {0, -1, 0}, random).radiance.x);
        }
        return found;
    };
    const auto with = trace();
    body->scene.clearance = {};
    EXPECT_EQ(trace(), with);
}

}  // namespace
}  // namespace opaline::tests
