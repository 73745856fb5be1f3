// What receivers get of lamps, straight and from surfaces.
#include "bake/effects/emitters/lamp_rows.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/bake/emitters/bounced_lamps.h"

namespace opaline::bake {
namespace {

// Irradiance 2 on walls of exitance 1 and albedo 1/2: light that arrives from outside of the room
// counts as none, and corners are as bright as the middle of a wall.
TEST(LampRows, InAFurnaceIsEvenEverywhere) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(4, true), 0.5f, std::numbers::inv_pi_v<float>);
    const tests::BouncedLamps lit(std::move(scene), 0.05, {100000});
    const auto rows = lit.rows(0);
    double sum = 0, area = 0;
    for (std::size_t r = 0; r < rows.at(0).size(); ++r) {
        const double irradiance = std::numbers::pi * double{rows[0][r].g};
        EXPECT_NEAR(irradiance, 2, 0.04);
        double share = 2;  // of a cell; its own wall counts as an edge
        for (int axis = 0; axis < 3; ++axis) {
            if (std::abs(lit.world.receivers[0].outside[r].origin[axis]) > 0.99f) share /= 2;
        }
        sum += share * irradiance;
        area += share;
    }
    EXPECT_NEAR(sum / area, 2, 0.01);
}

// Nothing leaks through a wall: what stands on its far side is dark.
TEST(LampRows, DoesNotPassThroughAThinWall) {
    formats::Scene scene = tests::parallel_squares(2);
    tests::add_surface(scene, tests::make_quad({-9, -9, 0.5f}, {20, 0, 0}, {0, 20, 0}), 0.8f);
    scene.materials[2].double_sided = true;
    const tests::BouncedLamps lit(std::move(scene), 0.05, {100000});
    const auto rows = lit.rows(1);
    for (const formats::Rgb& row : rows.at(0)) {
        EXPECT_EQ(row, formats::Rgb{});
    }
}

// A red wall lights what it faces red.
TEST(LampRows, ColourBleeds) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1), 1);
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 1), 1)
        .base_color = {0.8f, 0.1f, 0.1f};
    scene.lights.push_back({.name = "", .position = {0.7f, 0.5f, 0.8f}});
    const tests::BouncedLamps lit(std::move(scene), 0.05, {100000});
    const auto rows = lit.rows(0);
    const formats::Rgb beside = rows[0][0], away = rows[0][3];
    EXPECT_GT(beside.r, 1.05f * beside.g);
    EXPECT_LT(away.r / away.g, beside.r / beside.g);
}

// T_0 holds what the front shows, T_1 the back; a lamp on one side alone.
TEST(LampRows, ThinWallsShowLightOnBothSides) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 1).sheet =
        formats::Sheet{{0.6f, 0.6f, 0.6f}, {0.3f, 0.2f, 0.1f}};
    scene.lights.push_back({.name = "", .intensity = {4, 4, 4}, .position = {0, 0, 2}});
    const auto rows = tests::BouncedLamps(std::move(scene), 0.05, {1000}).rows(0, 2);
    const float E = 1 * std::numbers::inv_pi_v<float>;
    EXPECT_NEAR(rows[0][0].g, 0.6f * E, 1e-3f);
    EXPECT_NEAR(rows[0][1].r, 0.3f * E, 1e-3f);
    EXPECT_NEAR(rows[0][1].b, 0.1f * E, 1e-3f);
}

// All light that arrives at the square of one primitive from a lamp that covers another one's: a
// large floor, a small board that leans over it, and a wall beside both.
double arriving_flux(std::uint32_t lamp, std::uint32_t at) {
    constexpr std::uint32_t kCells = 8;
    formats::Scene scene;
    const auto radiance = [&](std::uint32_t p) { return p == lamp ? 1.0f : 0.0f; };
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}, kCells), 0.6f,
                       radiance(0));
    const glm::vec3 along(0, 0.8f, 0.3f), across(0.4f, 0, 0.2f);
    tests::add_surface(scene, tests::make_quad({1, 0.6f, 0.5f}, along, across, kCells), 0.3f,
                       radiance(1));
    tests::add_surface(scene, tests::make_quad({-0.2f, 0, 0.2f}, {0, 2, 0}, {0, 0, 1}, kCells),
                       0.8f);
    const formats::Primitive& square = scene.primitives[at];
    const double area = surface_area(square);
    const auto rows = tests::BouncedLamps(std::move(scene), 0.02, {100000}).rows(at);
    double mean = 0;
    for (std::size_t r = 0; r < rows.at(0).size(); ++r) {
        const std::size_t i = r % (kCells + 1), j = r / (kCells + 1);
        const double share = (i % kCells == 0 ? 0.5 : 1) * (j % kCells == 0 ? 0.5 : 1);
        mean += share * double{rows[0][r].g} / (kCells * kCells);
    }
    return std::numbers::pi * mean * area;
}

// Straight and by way of the wall and of each other.
TEST(LampRows, TwoFlatThingsSendEachOtherAsMuch) {
    const double down = arriving_flux(1, 0), up = arriving_flux(0, 1);
    EXPECT_GT(down, 0.1);
    EXPECT_NEAR(up / down, 1, 0.01) << up << " up, " << down << " down";
}

TEST(LampRows, LampsDoNotMixAndThreadsDoNotMatter) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(2, true), 0.5f);
    scene.lights.push_back({.name = "", .intensity = {1, 0, 0}});
    scene.lights.push_back({.name = "", .intensity = {0, 0, 1}, .position = {0.5f, 0, 0}});
    const tests::BouncedLamps lit(std::move(scene), 0.05, {10000});
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
