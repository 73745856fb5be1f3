// What lamps send and surfaces reflect through textures finer than what it is averaged over.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/straight_light.h"
#include "bake/scene/texture_pyramid.h"
#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

using tests::add_checker;
using tests::floor_under_ceiling;

// Particles that leave a checker again are as many, and as bright, as those that leave its mean.
TEST(TexturedLight, ParticlesLeaveAFineCheckerAsTheyLeaveItsMean) {
    const auto power_at_ceiling = [](const formats::Scene& scene, bool is_filtered) {
        const ScenePyramids textures = make_scene_pyramids(scene);
        const RayScene rays = tests::build_rays(scene);
        const ElementLayout layout(scene, 0.05);
        std::uint64_t traced = 0;
        const auto power =
            trace_particles(scene, rays, tests::all_sources(scene).at(0), layout,
                            {20000, 0, 0, 0, is_filtered ? &textures : nullptr}, Context{}, traced)
                .all;
        double sum = 0;
        const std::size_t first_of_floor = layout.element({1, 0, false}, glm::dvec3(1, 0, 0));
        for (std::size_t e = 0; e < std::min(first_of_floor, power.size()); ++e) {
            sum += power[e].power.y;
        }
        return sum;
    };
    formats::Scene checker = floor_under_ceiling(0.8f);
    checker.materials[1].base_color_image = add_checker(checker);
    const double mean = power_at_ceiling(floor_under_ceiling(0.4f), false);
    ASSERT_GT(mean, 0.01);
    EXPECT_NEAR(power_at_ceiling(checker, true) / mean, 1, 5e-3);
}

// Sixteen texels over 1280 triangles: hardly more parts than triangles, so that a painted glow
// costs what an even one does; a receiver takes far ones whole, however fine the texture is.
TEST(TexturedLight, ACoarseTextureCutsNoTriangleIntoManyParts) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_sphere(3), 0, 1);
    formats::Primitive& ball = scene.primitives[0];
    for (const glm::vec3& at : ball.position) {
        ball.texcoord.emplace_back(0.5f + 0.5f * at.x, 0.5f + 0.5f * at.y);
    }
    const auto parts_with = [&](std::uint32_t side) {
        formats::Image8 image{side, side, {}};
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const auto value = static_cast<std::uint8_t>(40 * (i % side * 5 / side));
            image.rgba.insert(image.rgba.end(), {value, value, value, 255});
        }
        scene.images = {image};
        scene.materials[0].emission_image = 0;
        return make_lamp_sources(scene, list_lamps(scene)[0]).triangles.size();
    };
    EXPECT_LT(parts_with(16), 4 * ball.index.size() / 3);
    EXPECT_LE(parts_with(1024), 65536u);
}

// A panel whose left half glows, seen from afar and from near by: the two halves of its light.
TEST(TexturedLight, PartsThatAreFarCountAsTheirMean) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0, 1);
    formats::Scene half = scene;
    half.primitives[0] = tests::make_quad({0, 0, 0}, {0.5f, 0, 0}, {0, 1, 0});
    for (const glm::vec3& at : scene.primitives[0].position) {
        scene.primitives[0].texcoord.emplace_back(at.x, at.y);
    }
    scene.materials[0].emission_image = 0;
    formats::Image8 image{64, 1, {}};
    for (std::uint32_t i = 0; i < 64; ++i) {
        const std::uint8_t value = i < 32 ? 255 : 0;
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    scene.images = {image};
    const auto irradiance = [](const formats::Scene& of, glm::vec3 at) {
        std::uint64_t rays = 0;
        return straight_irradiance(tests::build_rays(of), tests::all_sources(of)[0],
                                   {at, {0, 0, -1}}, 64, rays)
            .g;
    };
    for (const float height : {0.05f, 0.3f, 1.0f, 6.0f}) {
        const glm::vec3 at(0.4f, 0.5f, height);
        const double exact = irradiance(half, at);
        EXPECT_NEAR(irradiance(scene, at), exact, 0.05 * exact) << height;
    }
}

// Cut into 256 parts, whose middles may all be white.
TEST(TexturedLight, AGlowingTriangleHasThePowerOfItsTexturesMean) {
    formats::Scene scene = floor_under_ceiling(0);
    scene.materials[0].emission_image = add_checker(scene);
    const ScenePyramids textures = make_scene_pyramids(scene);
    const auto power_of = [&](const ScenePyramids* used) {
        double sum = 0;
        for (const GlowingTriangle& part :
             make_lamp_sources(scene, list_lamps(scene)[0], used).triangles) {
            sum += part.power().y;
        }
        return sum;
    };
    EXPECT_NEAR(power_of(&textures) / (0.5 * std::numbers::pi), 1, 1e-3);
    EXPECT_GT(std::abs(power_of(nullptr) / (0.5 * std::numbers::pi) - 1), 0.02);
}

}  // namespace
}  // namespace opaline::bake
