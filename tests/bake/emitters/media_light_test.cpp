// Light that media send out, as it is read at hits and as it starts again; and media as lamps find
// them.
#include "bake/lamps/media_light.h"

#include <gtest/gtest.h>

#include <numbers>

#include "bake/emitters/light_media.h"
#include "bake/emitters/media_patches.h"
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

TEST(MediaLight, IsMixedOverTrianglesAndStartsWithItsPower) {
    const formats::Scene scene = square_of_wax();
    MediaLight media{{std::vector<glm::vec3>(8)}};
    for (std::size_t v = 0; v < 4; ++v) {
        media.exitance[0][v] = glm::vec3(static_cast<float>(v) + 1);
        media.exitance[0][4 + v] = {0, 3, 0};
    }
    EXPECT_FALSE(media.empty());
    const std::uint32_t* const corner = scene.primitives[0].index.data();
    const glm::dvec3 mixed = media_exitance(scene, media, 0, {0, 0, false}, {0.5f, 0.25f, 0.25f});
    EXPECT_NEAR(mixed.x, 0.5 * corner[0] + 0.25 * corner[1] + 0.25 * corner[2] + 1, 1e-6);
    EXPECT_EQ(media_exitance(scene, media, 1, {0, 3, false}, {0, 0, 1}), glm::dvec3(0, 3, 0));
    EXPECT_EQ(media_exitance(scene, media, 1, {0, 3, true}, {0, 0, 1}), glm::dvec3(0));

    LampSources lamp;
    lamp.radius = 7;
    const LampSources sources = media_sources(scene, media, 1, lamp);
    ASSERT_EQ(sources.triangles.size(), 2u);
    const glm::dvec3 power = sources.triangles[0].power() + sources.triangles[1].power();
    EXPECT_NEAR(power.y, 3 * 4, 1e-5);
    EXPECT_EQ(power.x, 0);
    EXPECT_NEAR(sources.triangles[0].normal.z, 1, 1e-9);
    EXPECT_EQ(sources.radius, 7);
    EXPECT_TRUE(MediaLight{{{}}}.empty());
}

// The light of a lamp stands in its column, red, green and blue apart. Rows take their share of
// each band, and grey ones the luminance.
TEST(MediaLight, ColumnsHoldIrradiance) {
    formats::Scene scene = square_of_wax();
    scene.lights.push_back({.name = "A", .intensity = {1, 2, 3}, .position = {1, 1, 2}});
    scene.lights.push_back({.name = "B", .intensity = {8, 0, 0}, .position = {1, 1, 2}});
    const RayScene rays = tests::build_rays(scene);
    const auto sources = tests::all_sources(scene);
    const ElementLayout layout(scene, 1);
    const std::vector<ElementLight> nothing(2);
    const LampLight light{scene, rays, sources, layout, nothing, 16, 0};
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

// B_i+1 = 1 + q B_i, from 0: 1 / (1 - q), each lamp and band by itself.
TEST(SeriesSum, AddsWhatFurtherPassesWould) {
    const glm::vec3 q[2] = {{0.5f, 0.25f, 0}, {0.9f, 0.1f, 0.5f}};
    SeriesSum series(2, 0.05);
    MediaLight light{std::vector<std::vector<glm::vec3>>(2)};
    int passes = 0;
    for (bool is_last = false; !is_last; ++passes) {
        ASSERT_LT(passes, 100);
        MediaLight next{std::vector<std::vector<glm::vec3>>(2)};
        for (std::size_t i = 0; i < 6; ++i) {
            const glm::vec3 before =
                light.exitance[1].empty() ? glm::vec3(0) : light.exitance[1][i];
            next.exitance[1].push_back(glm::vec3(1) + q[i / 3] * before);
        }
        is_last = series.is_last(light, next, false);
        light = std::move(next);
    }
    EXPECT_LT(passes, 30);
    for (std::size_t i = 0; i < 6; ++i) {
        for (int b = 0; b < 3; ++b) {
            EXPECT_NEAR(light.exitance[1][i][b], 1 / (1 - q[i / 3][b]), 2e-3 / (1 - q[i / 3][b]));
        }
    }
    EXPECT_TRUE(SeriesSum(2, 0.05).is_last(light, light, false)) << "nothing changes";
}

TEST(ImmersedLamps, AreThoseInsideOfMediaNotInTheirHollows) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_sphere(2), 0.5f).medium.emplace();
    tests::add_surface(scene, tests::make_sphere(1, 0.2f), 0.5f, 1);
    const auto is_in = [&] {
        const RayScene rays = tests::build_rays(scene);
        return is_immersed(scene, rays, tests::all_sources(scene).front());
    };
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
