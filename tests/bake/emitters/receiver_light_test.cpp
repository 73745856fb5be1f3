// What receivers get of lamps, straight and from surfaces.
#include "bake/emitters/receiver_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/emitters/trace_particles.h"
#include "tests/bake/emitters/lamp_scenes.h"

namespace opaline::bake {
namespace {

/// Everything that rows of a scene are made from.
struct LitScene {
    explicit LitScene(formats::Scene given, std::uint32_t particles = 100000)
        : scene(std::move(given)),
          rays(tests::build_rays(scene)),
          sources(tests::all_sources(scene)),
          layout(scene, 0.05),
          receivers(tests::receivers_of(scene)) {
        std::uint64_t traced = 0;
        for (std::uint32_t lamp = 0; lamp < sources.size(); ++lamp) {
            const ParticleLight light = trace_particles(scene, rays, sources[lamp], layout,
                                                        {particles, lamp}, Context{}, traced);
            elements.push_back(layout.join(light.all, kGatheredElements));
            caustics.push_back(light.caustic.empty()
                                   ? ElementLight{}
                                   : layout.join(light.caustic, kCausticElements));
        }
    }
    LampLight light(std::uint32_t samples = 256) const {
        return {scene, rays, sources, layout, elements, samples, 0, nullptr, nullptr, caustics};
    }
    std::vector<std::vector<formats::Rgb>> rows(std::uint32_t primitive, std::uint32_t terms = 1,
                                                unsigned threads = 1) const {
        Context context;
        context.threads = threads;
        std::uint64_t traced = 0;
        return make_lamp_rows(light(), receivers[primitive], terms, context, traced);
    }

    formats::Scene scene;
    RayScene rays;
    std::vector<LampSources> sources;
    ElementLayout layout;
    std::vector<ReceiverSet> receivers;
    std::vector<ElementLight> elements, caustics;
};

// Irradiance 2 on walls of exitance 1 and albedo 1/2: light that arrives from outside of the room
// counts as none, and corners are as bright as the middle of a wall.
TEST(ReceiverLight, InAFurnaceIsEvenEverywhere) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(4, true), 0.5f, std::numbers::inv_pi_v<float>);
    const LitScene lit(std::move(scene));
    const auto rows = lit.rows(0);
    double sum = 0, area = 0;
    for (std::size_t r = 0; r < rows.at(0).size(); ++r) {
        const double irradiance = std::numbers::pi * double{rows[0][r].g};
        EXPECT_NEAR(irradiance, 2, 0.04);
        double share = 2;  // of a cell; its own wall counts as an edge
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(lit.receivers[0].outside[r].origin[axis]) > 0.99f) share /= 2;
        }
        sum += share * irradiance;
        area += share;
    }
    EXPECT_NEAR(sum / area, 2, 0.01);
}

// Nothing leaks through a wall: what stands on its far side is dark.
TEST(ReceiverLight, DoesNotPassThroughAThinWall) {
    formats::Scene scene = tests::parallel_squares(2);
    tests::add_surface(scene, tests::make_quad({-9, -9, 0.5f}, {20, 0, 0}, {0, 20, 0}), 0.8f);
    scene.materials[2].double_sided = true;
    const LitScene lit(std::move(scene));
    const auto rows = lit.rows(1);
    for (const formats::Rgb& row : rows.at(0)) {
        EXPECT_EQ(row, formats::Rgb{});
    }
}

// A red wall lights what it faces red.
TEST(ReceiverLight, ColourBleeds) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1), 1);
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1), 1)
        .base_color = {0.8f, 0.1f, 0.1f};
    scene.lights.push_back({.name = "", .position = {0.7f, 0.5f, 0.8f}});
    const LitScene lit(std::move(scene));
    const auto rows = lit.rows(0);
    const formats::Rgb beside = rows[0][0], away = rows[0][3];
    EXPECT_GT(beside.r, 1.05f * beside.g);
    EXPECT_LT(away.r / away.g, beside.r / beside.g);
}

// T_0 holds what the front shows, T_1 the back; a lamp on one side alone.
TEST(ReceiverLight, ThinWallsShowLightOnBothSides) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1).sheet =
        formats::Sheet{{0.6f, 0.6f, 0.6f}, {0.3f, 0.2f, 0.1f}};
    scene.lights.push_back({.name = "", .intensity = {4, 4, 4}, .position = {0, 0, 2}});
    const auto rows = LitScene(std::move(scene), 1000).rows(0, 2);
    const float E = 1 * std::numbers::inv_pi_v<float>;
    EXPECT_NEAR(rows[0][0].g, 0.6f * E, 1e-3f);
    EXPECT_NEAR(rows[0][1].r, 0.3f * E, 1e-3f);
    EXPECT_NEAR(rows[0][1].b, 0.1f * E, 1e-3f);
}

TEST(ReceiverLight, LampsDoNotMixAndThreadsDoNotMatter) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(2, true), 0.5f);
    scene.lights.push_back({.name = "", .intensity = {1, 0, 0}});
    scene.lights.push_back({.name = "", .intensity = {0, 0, 1}, .position = {0.5f, 0, 0}});
    const LitScene lit(std::move(scene), 10000);
    const auto rows = lit.rows(0);
    ASSERT_EQ(rows.size(), 2u);
    for (std::size_t i = 0; i < rows[0].size(); ++i) {
        EXPECT_GT(rows[0][i].r, 0);
        EXPECT_EQ(rows[0][i].b, 0);
        EXPECT_EQ(rows[1][i].r, 0);
        EXPECT_GT(rows[1][i].b, 0);
    }
    EXPECT_EQ(rows, lit.rows(0, 1, 4));
}

}  // namespace
}  // namespace opaline::bake
