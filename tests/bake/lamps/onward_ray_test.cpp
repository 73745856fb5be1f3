// Light of lamps by way of metals and through clear media.
#include "bake/exchange/lamps/onward_ray.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

formats::Scene with_light(formats::Light light) {
    formats::Scene scene;
    scene.lights.push_back(std::move(light));
    return scene;
}

void add_metal(formats::Scene& scene, formats::Primitive primitive, formats::Rgb color,
               float roughness) {
    formats::Material& metal = tests::add_surface(scene, std::move(primitive), 1);
    metal.base_color = color;
    metal.gloss.metallic = 1;
    metal.gloss.roughness = roughness;
}

formats::Medium glass(float eta, float absorption, float roughness = 0) {
    formats::Medium medium;
    medium.roughness = roughness;
    medium.sigma_s = {0, 0, 0};
    medium.sigma_a = {absorption, absorption, absorption};
    medium.eta = eta;
    return medium;
}

formats::Light sun_from_above() {
    return {.type = formats::Light::Type::directional, .name = "", .direction = {0, 0, -1}};
}

// A lamp 1 above a mirror of gold lights a black ceiling at 2 straight, and from its image 3 below:
// E = I cos^3 / d^2 each, the second one times gold's reflectance.
TEST(OnwardRay, MirrorShowsTheImageOfALamp) {
    formats::Scene scene = with_light({.name = "", .position = {0, 0, 1}});
    add_metal(scene, tests::make_quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), {1, 0.8f, 0.3f}, 0);
    tests::add_surface(scene, tests::make_quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), 0);
    const tests::LampWorld shone(scene, 0.02, {400000});
    for (const float x : {0.3f, 0.6f}) {
        const glm::dvec3 found = shone.at({{x, 0.25f, 1.999f}, {0, 0, -1}});
        const auto from = [&](double d) {
            return d / std::pow(d * d + double{x} * x + 0.0625, 1.5);
        };
        EXPECT_NEAR(found.x, from(1) + from(3), 0.05 * from(3));
        EXPECT_NEAR(found.z, from(1) + 0.3 * from(3), 0.05 * from(3));
    }
}

// At normal incidence a plate passes (1 - R) / (1 + R), with all reflections between its faces, of
// R = ((n - 1) / (n + 1))^2; one that absorbs passes (1 - R)^2 t / (1 - R^2 t^2).
TEST(OnwardRay, PlateOfGlassPassesLightAsFresnelSays) {
    for (const float absorption : {0.0f, 2.0f}) {
        formats::Scene scene = with_light(sun_from_above());
        formats::Primitive plate = tests::make_cube(1, false);
        for (glm::vec3& position : plate.position)
            position = {3 * position.x, 3 * position.y, 0.1f * position.z};
        tests::add_surface(scene, plate, 1).medium = glass(1.5f, absorption);
        tests::add_surface(scene, tests::make_quad({-1, -1, -1}, {2, 0, 0}, {0, 2, 0}), 0);
        const tests::LampWorld shone(scene, 2, {200000});
        const double R = 0.04, t = std::exp(-0.2 * double{absorption});
        const double expected = (1 - R) * (1 - R) * t / (1 - R * R * t * t);
        EXPECT_NEAR(shone.at({{0.2f, 0.1f, -0.999f}, {0, 0, 1}}).x, expected, 0.01);
    }
}

// All that enters leaves again, by one facet or another: 1 - R of a narrow beam reaches the walls,
// but for what facets send to other facets (3 % at roughness 0.4).
TEST(OnwardRay, RoughGlassKeepsNothing) {
    for (const float roughness : {0.0f, 0.2f}) {
        formats::Scene scene = with_light({.type = formats::Light::Type::spot,
                                           .name = "",
                                           .position = {0, 0, 0.9f},
                                           .direction = {0, 0, -1},
                                           .inner_cone = 0.1f,
                                           .outer_cone = 0.2f});
        tests::add_surface(scene, tests::make_cube(1, true), 0);
        formats::Primitive plate = tests::make_cube(1, false);
        for (glm::vec3& position : plate.position)
            position *= glm::vec3(0.8f, 0.8f, 0.1f);
        tests::add_surface(scene, plate, 1).medium = glass(1.5f, 0, roughness);
        const RayScene rays = tests::build_rays(scene);
        const auto sources = tests::all_sources(scene);
        const ElementLayout layout(scene, 1);
        std::uint64_t traced = 0;
        const ParticleLight light =
            trace_particles(scene, rays, sources[0], layout, {50000}, Context{}, traced);
        double on_walls = 0;
        for (std::size_t i = 0; i < layout.element({1, 0}, {1, 0, 0}); ++i)
            on_walls += light.caustic[i].power.x;
        const double power = light_power(sources[0], scene.lights[0]).x;
        EXPECT_NEAR(on_walls / power, 0.96, 0.008) << roughness;
    }
}

// A ball of glass gathers a sun's light behind it.
TEST(OnwardRay, BallOfGlassMakesACaustic) {
    formats::Scene scene = with_light(sun_from_above());
    tests::add_surface(scene, tests::make_sphere(5, 0.5f, {0, 0, 0.8f}), 1).medium = glass(1.5f, 0);
    tests::add_surface(scene, tests::make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), 0);
    const tests::LampWorld shone(scene, 1e-4, {200000});
    // Its focus is n r / 2 (n - 1) = 0.75 below its middle.
    EXPECT_GT(shone.at({{0, 0, 1e-4f}, {0, 0, 1}}).x, 20);
    EXPECT_LT(shone.at({{0.3f, 0, 1e-4f}, {0, 0, 1}}).x, 0.4);
    EXPECT_NEAR(shone.at({{0.8f, 0, 1e-4f}, {0, 0, 1}}).x, 1, 0.03);
}

// Facets draw where their density falls off: there the polygon of all numbers' steps is larger than
// the light is even [Suykens2001, 4.2]. Against 50 times the particles, each in its own element.
TEST(OnwardRay, CausticOfRoughGlassIsSharperByTheLimitOfTheGradient) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), 0);
    tests::add_surface(scene, tests::make_quad({-0.1f, -0.1f, 2}, {0, 0.2f, 0}, {0.2f, 0, 0}), 0,
                       1);
    tests::add_surface(scene, tests::make_sphere(5, 0.3f, {0, 0, 0.4f}), 1).medium =
        glass(1.5f, 0, 0.3f);
    const RayScene rays = tests::build_rays(scene);
    const auto sources = tests::all_sources(scene);
    const ElementLayout layout(scene, 4e-4);
    std::uint64_t traced = 0;
    const auto caustic_of = [&](const ParticleRun& run) {
        return layout
            .join(trace_particles(scene, rays, sources[0], layout, run, Context{}, traced).caustic,
                  {1.0 / 16, 16})
            .irradiance;
    };
    const auto truth = caustic_of({1000000, 0, 5, 1e-9});
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < 2; ++i) {
        const double limit = i == 0 ? 0.7 : std::numeric_limits<double>::infinity();
        const auto found = caustic_of({20000, 0, 0, 0, nullptr, false, limit});
        for (std::size_t e = 0; e < layout.element({1, 0}, {1, 0, 0}); ++e)
            error[i] += std::pow(double{found[e].x} - double{truth[e].x}, 2);
    }
    EXPECT_LT(std::sqrt(error[0]), 0.9 * std::sqrt(error[1]));
}

}  // namespace
}  // namespace opaline::bake
