// Light of lamps as media take it, and media as lamps find them.
#include "bake/effects/emitters/lit_media.h"

#include <gtest/gtest.h>

#include "bake/effects/emitters/immersed_lamps.h"
#include "bake/exchange/other_light.h"
#include "bake/receivers/surface_patches.h"
#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

// A square of 4 m^2 that shines up, of a medium.
formats::Scene square_of_wax() {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {2, 0, 0}, {0, 2, 0}), 0.5f)
        .medium.emplace();
    return scene;
}

// The light of a lamp stands in its column, red, green and blue apart. Rows take their share of
// each band, and grey ones the luminance.
TEST(LitMedia, ColumnsHoldIrradiance) {
    formats::Scene scene = square_of_wax();
    scene.lights.push_back({.name = "A", .intensity = {1, 2, 3}, .position = {1, 1, 2}});
    scene.lights.push_back({.name = "B", .intensity = {8, 0, 0}, .position = {1, 1, 2}});
    const RayScene rays = tests::build_rays(scene);
    const auto sources = tests::all_sources(scene);
    const LampLight lamps{scene, rays, sources, 16};
    const LampBounces light{lamps};
    const OtherLight columns{.lamps = &light, .environment = false};
    EXPECT_FALSE(has_environment(&columns));
    std::vector<float> rows(18);
    const Receiver at{{1, 1, 0.001f}, {0, 0, 1}};
    add_irradiance(columns, {at}, 1, rows);
    const float E = 1 / (1.999f * 1.999f);
    EXPECT_NEAR(rows[0], E, 1e-4);
    EXPECT_NEAR(rows[1], 8 * E, 1e-3);
    EXPECT_NEAR(rows[6], 2 * E, 1e-3);
    EXPECT_NEAR(rows[12], 3 * E, 1e-3);
    EXPECT_EQ(rows[7], 0);
    EXPECT_EQ(rows[2], 0);
    for (const std::uint32_t bands : {1u, 3u}) {
        std::vector<float> values(2 * bands * 6);
        const DenseRow row{values, 1, 2, bands};
        add_other_light(&columns, at, {{0, {0.5f, 0.5f, 0.5f}}, {1, {1, 1, 1}}}, row);
        for (std::uint32_t b = 0; b < bands; ++b) {
            const float all = bands == 1 ? 0.2126f + 2 * 0.7152f + 3 * 0.0722f : 1 + b;
            EXPECT_NEAR(row.plane(0, b)[0], 0.5f * all * E, 1e-4);
            EXPECT_NEAR(row.plane(1, b)[0], all * E, 1e-4);
            EXPECT_EQ(row.plane(0, b)[2], 0);
        }
    }
}

// Two sheets of points a hundredth of their width apart that face away from each other.
TEST(MediaPatches, FacesOfAThinWallAreApart) {
    std::vector<BodyPoint> points;
    points.reserve(512);
    for (int i = 0; i < 512; ++i) {
        const float side = i % 2 == 0 ? 0.005f : -0.005f;
        const int place = i / 2;
        points.push_back(
            {{static_cast<float>(place % 16) / 16, static_cast<float>(place) / 256, side},
             {0, 0, side > 0 ? 1 : -1},
             {},
             0});
    }
    const std::vector<std::uint32_t> patch = cut_into_patches(points, 24);
    std::vector<std::vector<std::size_t>> members(24);
    for (std::size_t i = 0; i < patch.size(); ++i) {
        ASSERT_LT(patch[i], 24u);
        members[patch[i]].push_back(i);
    }
    for (const auto& own : members) {
        ASSERT_FALSE(own.empty());
        EXPECT_LE(own.size(), 512u / 24 + 2);
        for (const std::size_t i : own) {
            EXPECT_EQ(points[i].normal, points[own.front()].normal);
            EXPECT_LT(std::abs(points[i].position.y - points[own.front()].position.y), 0.51f);
        }
    }
    EXPECT_EQ(cut_into_patches(std::span(points).first(3), 24).size(), 3u);
    EXPECT_TRUE(cut_into_patches({}, 24).empty());
}

TEST(ImmersedLamps, AreThoseInsideOfMediaNotInTheirHollows) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_sphere(2), 0.5f).medium.emplace();
    tests::add_surface(scene, tests::make_sphere(1, 0.2f), 0.5f, 1);
    const auto is_in = [&] {
        const RayScene rays = tests::build_rays(scene);
        return medium_around(scene, rays, tests::all_sources(scene).front()) == 0;
    };
    EXPECT_FALSE(is_in()) << "light crosses it";
    scene.materials[0].medium->sigma_s = {1, 1, 1};
    EXPECT_TRUE(is_in());
    scene.materials[0].medium.reset();
    EXPECT_FALSE(is_in()) << "opaque around it";
    scene.materials[0].medium.emplace();
    for (glm::vec3& position : scene.primitives[1].position) {
        position.x += 2;
    }
    EXPECT_FALSE(is_in()) << "beside it";
}

}  // namespace
}  // namespace opaline::bake
