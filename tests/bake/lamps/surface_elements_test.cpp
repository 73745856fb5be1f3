#include "bake/exchange/lamps/surface_elements.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "bake/exchange/lamps/receiver_light.h"
#include "bake/exchange/lamps/triangle_clusters.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/bake/path_differentials/random_inputs.h"

namespace opaline::bake {
namespace {

// Two triangles of area 1/2.
formats::Scene half_square(std::uint32_t cells = 1) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, cells), 0.5f);
    return scene;
}

glm::dvec3 random_weights(tests::RandomInputs& random) {
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) u = 1 - u, v = 1 - v;
    return {1 - u - v, u, v};
}

/// Power 1 in every element, with the same footprint.
std::vector<ElementDeposit> even_deposits(const ElementLayout& layout, double footprint) {
    return std::vector<ElementDeposit>(layout.size(),
                                       {glm::dvec3(1, 0, 0), 1, 1, std::log(footprint)});
}

std::map<std::uint32_t, std::size_t> count_groups(const ElementLight& light) {
    std::map<std::uint32_t, std::size_t> groups;
    for (const std::uint32_t group : light.together)
        ++groups[group];
    return groups;
}

TEST(SurfaceElements, AreAboutAsLargeAsTheFinest) {
    const formats::Scene scene = half_square();
    EXPECT_EQ(reflecting_area(scene), 1);
    const ElementLayout layout(scene, 0.5 / 256);
    EXPECT_EQ(layout.size(), 2u * 256);
    EXPECT_EQ(ElementLayout(scene, 0.5 / 257).size(), 2u * 256);
    EXPECT_EQ(ElementLayout(scene, 9).size(), 2u);
    const glm::dvec3 at(0.9, 0.05, 0.05);
    EXPECT_LT(layout.element({0, 0}, at), 256u);
    EXPECT_GE(layout.element({0, 3}, at), 256u);
    EXPECT_EQ(layout.element({0, 0, true}, at), layout.size());  // the back
}

TEST(SurfaceElements, BothSidesOfWhatIsSeenFromBothHaveElements) {
    formats::Scene scene = half_square();
    scene.materials[0].double_sided = true;
    EXPECT_EQ(reflecting_area(scene), 2);
    const ElementLayout layout(scene, 0.1);
    const glm::dvec3 at(0.3, 0.3, 0.4);
    EXPECT_NE(layout.element({0, 0, true}, at), layout.element({0, 0, false}, at));
    EXPECT_LT(layout.element({0, 3, true}, at), layout.size());
}

// Groups of a triangle are four times as large from level to level: the largest up to sqrt(2)
// footprints.
TEST(SurfaceElements, JoinUpToTheSizeOfFootprints) {
    const formats::Scene scene = half_square();
    const ElementLayout layout(scene, 0.5 / 256);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 0.5 / 1000))).size(), 512u);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 0.5 / 64 / 1.41))).size(), 128u);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 0.5 / 64 / 1.42))).size(), 512u);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 0.36))).size(), 2u);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 0.71))).size(), 1u);  // a cluster
}

TEST(SurfaceElements, JoinBeyondFootprintsUntilThereAreParticlesEnough) {
    const formats::Scene scene = half_square();
    const ElementLayout layout(scene, 0.5 / 256);
    const auto deposits = even_deposits(layout, 1e-9);
    EXPECT_EQ(count_groups(layout.join(deposits, {1, 16})).size(), 512u / 4);
    EXPECT_EQ(count_groups(layout.join(deposits, {1, 17})).size(), 512u / 16);
    EXPECT_EQ(count_groups(layout.join(deposits, {1, 1})).size(), 512u);
}

// A square of 8192 triangles has groups as large as one of two triangles, and one value each.
TEST(SurfaceElements, SmallTrianglesJoinAcrossTheirEdges) {
    const formats::Scene scene = half_square(64);
    const ElementLayout layout(scene, 1);
    ASSERT_EQ(layout.size(), 8192u);
    const ElementLight light = layout.join(even_deposits(layout, 1.0 / 128));
    const auto groups = count_groups(light);
    EXPECT_EQ(groups.size(), 128u);
    for (const auto& [group, size] : groups)
        EXPECT_EQ(size, 64u);
    EXPECT_EQ(count_groups(layout.join(even_deposits(layout, 1e-9))).size(), 8192u);
}

// Normals of a cube's faces are 90 degrees apart; shelves do not touch.
TEST(SurfaceElements, DoNotJoinAroundEdgesAndFromSurfaceToSurface) {
    formats::Scene cube;
    tests::add_surface(cube, tests::make_cube(8, true), 0.5f);
    const ElementLayout of_cube(cube, 1);
    EXPECT_EQ(count_groups(of_cube.join(even_deposits(of_cube, 1e9))).size(), 6u);

    formats::Primitive shelves = tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const formats::Primitive upper = tests::make_quad({0, 0, 0.1f}, {1, 0, 0}, {0, 1, 0});
    const auto first = static_cast<std::uint32_t>(shelves.position.size());
    shelves.position.insert(shelves.position.end(), upper.position.begin(), upper.position.end());
    for (const std::uint32_t i : upper.index)
        shelves.index.push_back(first + i);
    formats::Scene scene;
    tests::add_surface(scene, shelves, 0.5f);
    const ElementLayout layout(scene, 0.1);
    for (const auto& [group, size] : count_groups(layout.join(even_deposits(layout, 1e9))))
        EXPECT_LE(size, layout.size() / 2);
}

// What lands in a group is spread over it, whatever the footprints: the sum is what was given.
TEST(SurfaceElements, SumIsThePowerReceivedWhateverTheFootprints) {
    for (const std::uint32_t cells : {1u, 7u}) {
        const formats::Scene scene = half_square(cells);
        const ElementLayout layout(scene, 0.5 / 1024);
        tests::RandomInputs random(50);
        std::vector<ElementDeposit> deposits(layout.size());
        double received = 0;
        for (int i = 0; i < 20000; ++i) {
            const auto triangle = static_cast<std::uint32_t>(random.uniform() * 2 * cells * cells);
            const double p = random.uniform(0, 1e-3);
            ElementDeposit& to =
                deposits[layout.element({0, 3 * triangle}, random_weights(random))];
            received += p;
            to.power += glm::dvec3(p, 0, 0);
            to.weight += p;
            to.weight_squares += p * p;
            to.log_footprint += p * random.uniform(-12, 1);
        }
        const double kept =
            std::accumulate(deposits.begin(), deposits.end(), 0.0,
                            [](double sum, const ElementDeposit& of) { return sum + of.power.x; });
        EXPECT_NEAR(kept, received, 1e-12 * received);
        const ElementLight light = layout.join(deposits);
        double spread = 0;
        for (const glm::vec3& irradiance : light.irradiance)
            spread += double{irradiance.x} / static_cast<double>(layout.size());
        EXPECT_NEAR(spread, received, 1e-6 * received);  // floats
        EXPECT_GT(count_groups(light).size(), 10u);
    }
}

// Small footprints at one corner keep what they brought there; the rest of the triangle is joined.
TEST(SurfaceElements, AreFineOnlyWhereFootprintsAreSmall) {
    const formats::Scene scene = half_square();
    const ElementLayout layout(scene, 0.5 / 256);
    std::vector<ElementDeposit> deposits = even_deposits(layout, 0.06);
    const std::size_t fine = layout.element({0, 0}, {0.99, 0.005, 0.005});
    deposits[fine] = {glm::dvec3(1000, 0, 0), 1000, 1e6, 1000 * std::log(1e-6)};
    const ElementLight light = layout.join(deposits);
    const double area = 0.5 / 256;
    EXPECT_NEAR(light.irradiance[fine].x, 1000 / area, 1);
    EXPECT_NEAR(light.irradiance[fine + 1].x, 1 / area, 1e-3);  // a sibling
    // Whole parts beside the corner's: 3 of each level; groups of 0.5 / 16 elsewhere, or smaller.
    const auto groups = count_groups(light);
    EXPECT_EQ(groups.at(light.together[fine]), 1u);
    EXPECT_EQ(groups.at(light.together[layout.element({0, 3}, {0.3, 0.3, 0.4})]), 16u);
    EXPECT_LT(groups.size(), 50u);
}

TEST(SurfaceElements, TrianglesWithoutAreaTakeNothing) {
    formats::Scene scene = half_square();
    for (glm::vec3& position : scene.primitives[0].position)
        position.y = 0;
    const ElementLayout layout(scene, 0.1);
    for (const glm::vec3& irradiance : layout.join(even_deposits(layout, 1)).irradiance) {
        EXPECT_EQ(irradiance, glm::vec3(0));
    }
}

TEST(TriangleClusters, TrianglesInOnePlaceStandInTheListOnceEach) {
    formats::Primitive pile;
    pile.position = {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}};
    for (int i = 0; i < 1000; ++i) {
        pile.index.insert(pile.index.end(), {0, 1, 2});
    }
    const TriangleClusters clusters = cluster_triangles(pile);
    std::vector<std::uint32_t> order = clusters.order, all(1000);
    std::ranges::sort(order);
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(order, all);
    std::uint32_t count = 0;
    for (const TriangleCluster& chart : clusters.charts) {
        count += chart.count;
    }
    EXPECT_EQ(count, 1000u);
}

// At edges and corners receivers lie beside the face, by a rounding, clear of the other ones.
TEST(CausticElements, AreReadAtEdgesAndCornersAsInTheMiddle) {
    const formats::Scene scene = half_square();
    const RayScene rays = tests::build_rays(scene);
    const ElementLayout layout(scene, 0.01);
    const std::vector<ElementLight> caustics{
        {std::vector<glm::vec3>(layout.size(), {3, 2, 1}), {}}};
    std::vector<LampSources> sources(1);
    sources.front().radius = 1;
    LampLight light{scene, rays, sources};
    light.caustics = caustics;
    light.layout = &layout;
    for (const glm::vec2 at : {glm::vec2(0.4f, 0.3f), glm::vec2(-3e-7f, 0.4f),
                               glm::vec2(-3e-7f, -3e-7f), glm::vec2(1 + 3e-7f, 1 + 3e-7f)}) {
        std::vector<glm::dvec3> sum(1, glm::dvec3(0));
        std::uint64_t traced = 0;
        add_caustics(light, {{at, 1e-7f}, {0, 0, 1}}, sum, traced);
        EXPECT_NEAR(sum[0].x, 3, 1e-6) << at.x << ", " << at.y;
    }
}

}  // namespace
}  // namespace opaline::bake
