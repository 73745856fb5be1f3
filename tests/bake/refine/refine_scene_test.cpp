#include "bake/refine/refine_scene.h"

#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

#include "bake/base/rng.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/surface_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/shared_rows.h"
#include "bake/trace/contacts.h"
#include "bake/trace/hidden_receivers.h"
#include "bake/trace/irradiance_transport.h"
#include "bake/trace/touching_triangles.h"
#include "formats/opal/cubemap.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

using formats::Scene;

RefineLimits some_limits(double error) {
    RefineLimits limits;
    limits.error = error;
    limits.most_added = 100000;
    return limits;
}

RefinedScene refine(const Scene& scene, const RefineLimits& limits, unsigned threads = 2) {
    Context context;
    context.threads = threads;
    const RayScene rays = RayScene::build(scene, 2).value();
    std::vector<LampSources> lamps;
    for (const Lamp& lamp : list_lamps(scene)) {
        lamps.push_back(make_lamp_sources(scene, lamp));
    }
    return refine_scene(scene, rays, lamps, limits, context);
}

// Relative RMS, over a primitive's surface, of what vertices interpolate of a function; as far as
// x and z are `within` [m].
template <class Function>
double interpolation_error(const Scene& scene, std::uint32_t primitive, Function&& exact,
                           float within = 1e30f) {
    const AreaTable table = make_area_table(scene, {primitive});
    double error = 0, sum = 0;
    for (const SurfacePoint& at : scatter_points(scene, table, 5000, false, 1)) {
        if (std::max(std::abs(at.position.x), std::abs(at.position.z)) > within) continue;
        const formats::Primitive& p = scene.primitives[primitive];
        double found = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            found += static_cast<double>(at.barycentric[static_cast<glm::length_t>(k)]) *
                     exact(p.position[p.index[at.first_index + k]]);
        }
        const double truth = exact(at.position);
        error += (found - truth) * (found - truth);
        sum += truth * truth;
    }
    return std::sqrt(error / sum);
}

constexpr float kRadius = 0.3f, kHeight = 0.4f;
Scene ball_over_two_triangles(float half = 2) {
    return tests::make_scene(
        {tests::make_quad({-half, 0, -half}, {0, 0, 2 * half}, {2 * half, 0, 0}),
         tests::make_sphere(3, kRadius, {0.3f, kHeight, 0.2f})});
}

// Irradiance of the even sky over pi: what the ball leaves, whose form factor is (r/d)^2 h/d.
double open_share(glm::vec3 x) {
    const glm::dvec3 way = glm::dvec3(0.3f, kHeight, 0.2f) - glm::dvec3(x);
    const double d = glm::length(way);
    return 1 - (double{kRadius} / d) * (double{kRadius} / d) * (way.y / d);
}

TEST(RefineScene, TwoTrianglesUnderABallGetItsShadow) {
    const Scene scene = ball_over_two_triangles();
    EXPECT_GT(interpolation_error(scene, 0, open_share), 0.05);
    const RefinedScene found = refine(scene, some_limits(0.05));
    ASSERT_TRUE(found.scene);
    EXPECT_LT(interpolation_error(*found.scene, 0, open_share), 0.015);
    EXPECT_GT(found.report.error_before, 0.08);
    EXPECT_LE(found.report.error_after, 0.05);
    EXPECT_LT(found.report.added, 1500u);  // an even grid as good as theirs has 60 x 60
    EXPECT_EQ(found.report.added,
              found.scene->primitives[0].added.size() + found.scene->primitives[1].added.size());
}

// A picture shows the ball and what is around it, however far the ground goes on. Relative to all
// of the ground's light the shadow would pass unnoticed.
TEST(RefineScene, OpenGroundAroundDoesNotMakeAShadowCoarser) {
    const RefinedScene found = refine(ball_over_two_triangles(12), some_limits(0.05));
    ASSERT_TRUE(found.scene);
    EXPECT_LT(interpolation_error(*found.scene, 0, open_share, 2), 0.03);
    EXPECT_LT(found.report.added, 1500u);
}

// Below a floor of one side there is nothing; below an opaque wall there is open sky, which is not
// shaded.
TEST(RefineScene, AWallIsDividedAsAFloorOfOneSideIs) {
    Scene scene = ball_over_two_triangles();
    const std::uint64_t floor = refine(scene, some_limits(0.04)).report.added;
    scene.materials.resize(2);
    scene.primitives[0].material = 1;
    scene.materials[1].sheet = formats::Sheet{};
    const std::uint64_t wall = refine(scene, some_limits(0.04)).report.added;
    EXPECT_GT(floor, 100u);
    EXPECT_GT(static_cast<double>(wall), 0.8 * static_cast<double>(floor));
    EXPECT_LT(static_cast<double>(wall), 1.25 * static_cast<double>(floor));
}

// Cards that shade each other in random order: each receiver sees another world.
TEST(RefineScene, EndsWhereMoreReceiversHardlyLowerTheError) {
    std::vector<formats::Primitive> cards;
    const auto any = [](std::uint64_t number) {
        const std::array<float, 4> u = random_uniform(1, RandomStage::refine_probes, number);
        return glm::vec3(u[0], u[1], u[2]) - 0.5f;
    };
    for (std::uint64_t i = 0; i < 300; ++i) {
        const glm::vec3 a = 0.4f * glm::normalize(any(3 * i));
        cards.push_back(tests::make_quad(any(3 * i + 1), a, glm::cross(a, any(3 * i + 2))));
    }
    Scene scene = tests::make_scene(std::move(cards));
    scene.materials[0].sheet = formats::Sheet{};
    RefineLimits limits = some_limits(0.02);
    limits.most_added = 4000;
    EXPECT_EQ(refine(scene, limits).report.end, RefineEnd::returns);
}

// 500; by one estimate of each row alone 37,000.
TEST(RefineScene, RoundingToAFewRaysAddsFewReceivers) {
    EXPECT_LT(refine(ball_over_two_triangles(), some_limits(0.01)).report.added, 1000u);
}

// A shadow of a few of many small triangles: most of them lie where no point looks at first.
TEST(RefineScene, NeighboursOfWhatErrsAreLookedAtInADenseMesh) {
    const Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}, 24),
                                           tests::make_sphere(3, 0.15f, {0.3f, 0.16f, 0.2f})});
    const RefineLimits limits = some_limits(0.005);
    const RefinedScene found = refine(scene, limits);
    ASSERT_TRUE(found.scene);
    EXPECT_LT(found.report.error_after, 0.4 * found.report.error_before);
}

TEST(RefineScene, VolumesCastShadowsToo) {
    Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0})});
    formats::SparseGrid<float> ball = tests::make_ball_grid(0.3, 0.05);
    ball.to_scene = glm::translate(glm::dmat4(1), {0.3, 0.4, 0.2}) * ball.to_scene;
    scene.volumes = {tests::make_volume(std::move(ball), 40, 0.5f, 0)};
    EXPECT_GT(refine(scene, some_limits(0.05)).report.added, 30u);
}

TEST(RefineScene, FinerLimitsFollowTheShadowFurther) {
    const Scene scene = ball_over_two_triangles();
    const RefinedScene coarse = refine(scene, some_limits(0.06));
    const RefinedScene fine = refine(scene, some_limits(0.02));
    EXPECT_GT(fine.report.added, 2 * coarse.report.added);
    EXPECT_LT(interpolation_error(*fine.scene, 0, open_share),
              interpolation_error(*coarse.scene, 0, open_share));
}

TEST(RefineScene, NothingIsAddedWhereNothingBlocksTheLight) {
    const Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0})});
    EXPECT_FALSE(refine(scene, some_limits(0.01)).scene);
}

TEST(RefineScene, BacksOfThinWallsCount) {
    Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}),
                                     tests::make_sphere(3, 0.3f, {0, -0.4f, 0})});
    EXPECT_EQ(refine(scene, some_limits(0.05)).scene.value_or(scene).primitives[0].added.size(),
              0u);
    scene.materials.resize(2);
    scene.primitives[0].material = 1;
    scene.materials[1].sheet = formats::Sheet{};
    EXPECT_GT(refine(scene, some_limits(0.03)).report.added, 30u);
}

// E = I h / d^3 below a point light: 3 % where it interpolates, without one occluder.
TEST(RefineScene, ALampCloseToAFloorGetsReceiversBelowIt) {
    Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0})});
    formats::Light lamp;
    lamp.name = "lamp";
    lamp.position = {0.5f, 0.4f, 0.1f};
    scene.lights = {lamp};
    const RefinedScene found = refine(scene, some_limits(0.05));
    ASSERT_TRUE(found.scene);
    const double error = interpolation_error(*found.scene, 0, [&](glm::vec3 x) {
        const glm::dvec3 way = glm::dvec3(lamp.position) - glm::dvec3(x);
        return way.y / std::pow(glm::dot(way, way), 1.5);
    });
    EXPECT_LT(error, 0.06);
}

TEST(RefineScene, ALampBehindAWallCounts) {
    Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0})});
    formats::Light lamp;
    lamp.name = "lamp";
    lamp.position = {0.5f, -0.4f, 0.1f};
    scene.lights = {lamp};
    EXPECT_FALSE(refine(scene, some_limits(0.05)).scene);
    scene.materials[0].sheet = formats::Sheet{};
    EXPECT_GT(refine(scene, some_limits(0.05)).report.added, 30u);
}

// A lamp as wide as what hides it: half of the floor lies in its penumbra, which a few rays see in
// steps. 300 receivers; by one estimate 43,000.
TEST(RefineScene, StepsOfAPenumbraSeenByAFewRaysAddFewReceivers) {
    Scene scene = tests::make_scene({tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}),
                                     tests::make_sphere(3, 0.3f, {0.3f, 1.6f, 0.2f}),
                                     tests::make_sphere(2, 0.3f, {0, 0.8f, 0})});
    scene.materials.resize(2);
    scene.primitives[1].material = 1;
    scene.materials[1].emission = {1000, 1000, 1000};
    RefineLimits limits = some_limits(0.02);
    limits.most_added = 2000;
    EXPECT_LT(refine(scene, limits).report.added, 700u);
}

// Light reaches through a bar as far as it diffuses: of a dense one that is shorter than its sides.
TEST(RefineScene, MediaGetReceiversWhereTheyAreThin) {
    Scene scene = tests::make_scene({tests::make_cube(1, false)});
    scene.materials[0].medium = tests::make_grey_medium(20, 0.05f);
    EXPECT_GT(refine(scene, some_limits(0.05)).report.added, 20u);
    scene.materials[0].medium = tests::make_grey_medium(0.01f, 0.0001f);  // as clear everywhere
    EXPECT_FALSE(refine(scene, some_limits(0.05)).scene);
}

TEST(RefineScene, TheLimitOfReceiversHolds) {
    RefineLimits limits = some_limits(0.01);
    limits.most_added = 100;
    const RefinedScene found = refine(ball_over_two_triangles(), limits);
    EXPECT_TRUE(found.report.is_bounded());
    EXPECT_GE(found.report.added, 100u);
    EXPECT_LE(found.report.added, 110u);  // neighbours of the last one are halved with it
}

TEST(RefineScene, LongEdgesAreHalvedWhateverTheLightDoes) {
    RefineLimits limits = some_limits(0);
    limits.longest_edge = 0.3;
    const RefinedScene found = refine(ball_over_two_triangles(), limits);
    ASSERT_TRUE(found.scene);
    const formats::Primitive& p = found.scene->primitives[0];
    for (std::size_t i = 0; i < p.index.size(); ++i) {
        const std::size_t next = i % 3 == 2 ? i - 2 : i + 1;
        EXPECT_LE(glm::distance(p.position[p.index[i]], p.position[p.index[next]]), 0.3f);
    }
}

TEST(RefineScene, ResultIsTheSameForAnyNumberOfThreads) {
    const RefinedScene one = refine(ball_over_two_triangles(), some_limits(0.04), 1);
    const RefinedScene three = refine(ball_over_two_triangles(), some_limits(0.04), 3);
    ASSERT_TRUE(one.scene && three.scene);
    EXPECT_EQ(one.scene->primitives[0].index, three.scene->primitives[0].index);
    EXPECT_EQ(one.scene->primitives[0].position, three.scene->primitives[0].position);
}

// Middles of edges are rounded: a room closed to light must stay dark at all of them.
TEST(RefineScene, ARoomThatLightCannotEnterStaysBlackAtAddedReceivers) {
    RefineLimits limits = some_limits(0);
    limits.longest_edge = 0.25;
    const Scene room = tests::make_scene({tests::transformed(
        tests::make_cube(1, true), tests::some_rotation(), 1.37f, {11.3f, -7.1f, 3.3f})});
    const RefinedScene found = refine(room, limits);
    ASSERT_TRUE(found.scene);
    const RayScene rays = RayScene::build(*found.scene, 2).value();
    const DirectionSet directions = make_direction_set(8);
    std::vector<float> transport(6 * 8 * 8);
    for (const Receiver& receiver : make_vertex_receivers(*found.scene)) {
        gather_irradiance(rays, directions, receiver, transport);
        EXPECT_EQ(*std::ranges::max_element(transport), 0);
    }
}

// Irradiance of an even sky over pi.
std::vector<float> openness_at(const RayScene& rays, const std::vector<Receiver>& receivers) {
    const DirectionSet directions = make_direction_set(8);
    std::vector<float> transport(6 * 8 * 8);
    const std::vector<double> area = formats::texel_solid_angles(8);
    std::vector<float> open;
    for (const Receiver& receiver : receivers) {
        gather_irradiance(rays, directions, receiver, transport);
        double sum = 0;
        for (std::size_t j = 0; j < transport.size(); ++j) {
            sum += area[j % area.size()] * static_cast<double>(transport[j]);
        }
        open.push_back(static_cast<float>(sum / std::numbers::pi));
    }
    return open;
}

// At vertices as a bake places them.
std::vector<float> openness_of(const Scene& scene) {
    const RayScene rays = RayScene::build(scene, 2).value();
    std::vector<Receiver> vertices =
        leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), {});
    std::vector<BodyPoint> inside = make_body_points(scene, vertices);
    std::vector<std::uint32_t> all(vertices.size());
    std::iota(all.begin(), all.end(), 0u);
    look_beside_contacts(find_contacts(rays.hierarchy(), scene, all, {}), vertices, inside);
    return openness_at(rays, replace_hidden_receivers(rays, scene, vertices, {}));
}

// A room closed to light stands on a floor that runs on below its walls, which are .1 thick. What
// vertices under the walls and outside see must not reach its corners: of the floor inside, no more
// than three thousandths of an open floor's light, where triangles reach round corners of walls.
TEST(RefineScene, AFloorThatRunsOnBelowTheWallsOfADarkRoomIsDarkUpToThem) {
    const glm::mat3 turned(glm::rotate(glm::mat4(1), 0.3f, {0, 1, 0}));
    const Scene scene = tests::make_scene(
        {tests::make_quad({-2, 0, -2}, {0, 0, 4}, {4, 0, 0}),
         tests::transformed(tests::make_cube(1, false), turned, 1.1f, {0, 0.1f, 0}),
         tests::transformed(tests::make_cube(1, true), turned, 1.0f, {0, 0.1f, 0})});
    const RefinedScene found = refine(scene, some_limits(0.1));
    ASSERT_TRUE(found.scene);
    const std::vector<float> open = openness_of(*found.scene);
    const formats::Primitive& floor = found.scene->primitives[0];
    double lit = 0;
    std::size_t points = 0;
    for (const SurfacePoint& at :
         scatter_points(*found.scene, make_area_table(*found.scene, {0}), 20000, false, 1)) {
        const glm::vec3 local = glm::transpose(turned) * at.position;
        if (std::abs(local.x) > 0.999f || std::abs(local.z) > 0.999f) continue;
        float value = 0;
        for (std::uint32_t k = 0; k < 3; ++k) {
            value += at.barycentric[static_cast<glm::length_t>(k)] *
                     open[floor.index[at.first_index + k]];
        }
        lit += static_cast<double>(value);
        ++points;
    }
    EXPECT_GT(points, 4000u);
    EXPECT_LT(lit / static_cast<double>(points), 0.003);
}

double least_openness(const Scene& scene) {
    const RayScene rays = RayScene::build(scene, 2).value();
    return static_cast<double>(std::ranges::min(openness_at(rays, make_vertex_receivers(scene))));
}

// Smooth shading of few facets: a receiver that is added looks from the smooth surface, as points
// of a coarse mesh do, and not from a facet's horizon. So it does where triangles share no
// vertices.
TEST(RefineScene, AddedReceiversSeeTheHorizonOfTheSmoothSurface) {
    const Scene scene = tests::make_scene({tests::make_sphere(0)});
    RefineLimits limits = some_limits(0);
    limits.longest_edge = 0.15;
    const RefinedScene found = refine(scene, limits);
    ASSERT_TRUE(found.scene);
    EXPECT_GT(least_openness(*found.scene), 0.97);
    Scene apart = scene;
    formats::Primitive& p = apart.primitives[0];
    const formats::Primitive whole = std::exchange(p, {});
    for (const std::uint32_t corner : whole.index) {
        p.index.push_back(static_cast<std::uint32_t>(p.position.size()));
        p.position.push_back(whole.position[corner]);
        p.normal.push_back(whole.normal[corner]);
    }
    const RefinedScene unwelded = refine(apart, limits);
    ASSERT_TRUE(unwelded.scene);
    const formats::Slots slots = find_slots(*unwelded.scene);
    const Scene merged = merge_vertices(*unwelded.scene, slots.view());
    EXPECT_EQ(merged.primitives[0].position.size(), found.scene->primitives[0].position.size());
    EXPECT_GT(merged.primitives[0].added.size(), 100u);
    EXPECT_GT(least_openness(merged), 0.97);
}

}  // namespace
}  // namespace opaline::bake
