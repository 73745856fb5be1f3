// Light of lamps by way of metals and through clear media.
#include "bake/emitters/onward_ray.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "bake/emitters/emitter_error.h"
#include "bake/emitters/receiver_light.h"
#include "bake/emitters/trace_particles.h"
#include "tests/bake/emitters/lamp_scenes.h"

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

formats::Medium glass(float eta, float absorption) {
    formats::Medium medium;
    medium.sigma_s = {0, 0, 0};
    medium.sigma_a = {absorption, absorption, absorption};
    medium.eta = eta;
    return medium;
}

formats::Light sun_from_above() {
    return {.type = formats::Light::Type::directional, .name = "", .direction = {0, 0, -1}};
}

struct Shone {
    explicit Shone(const formats::Scene& given, double finest, ParticleRun run)
        : scene(given),
          rays(tests::build_rays(scene)),
          sources(tests::all_sources(scene)),
          layout(scene, finest) {
        std::uint64_t traced = 0;
        const ParticleLight light =
            trace_particles(scene, rays, sources[0], layout, run, Context{}, traced);
        elements = {layout.join(light.all, kGatheredShare)};
        caustics = {light.caustic.empty() ? ElementLight{} : layout.join(light.caustic)};
    }
    LampLight light(std::uint32_t samples) const {
        return {scene, rays, sources, layout, elements, samples, 0, nullptr, nullptr, caustics};
    }
    glm::dvec3 at(const Receiver& receiver) const {
        std::uint64_t traced = 0;
        return receive_light(light(64), receiver, 1, traced)[0];
    }

    const formats::Scene& scene;
    RayScene rays;
    std::vector<LampSources> sources;
    ElementLayout layout;
    std::vector<ElementLight> elements, caustics;
};

// A lamp 1 above a mirror of gold lights a black ceiling at 2 straight, and from its image 3 below:
// E = I cos^3 / d^2 each, the second one times gold's reflectance.
TEST(OnwardRay, MirrorShowsTheImageOfALamp) {
    formats::Scene scene = with_light({.name = "", .position = {0, 0, 1}});
    add_metal(scene, tests::make_quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}), {1, 0.8f, 0.3f}, 0);
    tests::add_surface(scene, tests::make_quad({-1, -1, 2}, {0, 2, 0}, {2, 0, 0}), 0);
    const Shone shone(scene, 0.02, {400000});
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
        const Shone shone(scene, 2, {200000});
        const double R = 0.04, t = std::exp(-0.2 * double{absorption});
        const double expected = (1 - R) * (1 - R) * t / (1 - R * R * t * t);
        EXPECT_NEAR(shone.at({{0.2f, 0.1f, -0.999f}, {0, 0, 1}}).x, expected, 0.01);
    }
}

// A ball of glass gathers a sun's light behind it.
TEST(OnwardRay, BallOfGlassMakesACaustic) {
    formats::Scene scene = with_light(sun_from_above());
    tests::add_surface(scene, tests::make_sphere(5, 0.5f, {0, 0, 0.8f}), 1).medium = glass(1.5f, 0);
    tests::add_surface(scene, tests::make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), 0);
    const Shone shone(scene, 1e-4, {200000});
    // Its focus is n r / 2 (n - 1) = 0.75 below its middle.
    EXPECT_GT(shone.at({{0, 0, 1e-4f}, {0, 0, 1}}).x, 20);
    EXPECT_LT(shone.at({{0.3f, 0, 1e-4f}, {0, 0, 1}}).x, 0.2);
    EXPECT_NEAR(shone.at({{0.8f, 0, 1e-4f}, {0, 0, 1}}).x, 1, 0.03);
}

// Particles, gather rays and paths see the same room with a block of brass and a ball of glass.
TEST(OnwardRay, RowsBesideMetalAndGlassAreThoseOfPathTracing) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(2, true), 0.6f);
    tests::add_surface(scene, tests::make_quad({-0.5f, -0.5f, 0.98f}, {0, 1, 0}, {1, 0, 0}), 0, 1);
    formats::Primitive block = tests::make_cube(1, false);
    for (glm::vec3& position : block.position)
        position = 0.35f * position + glm::vec3(0.4f, 0.3f, -0.64f);
    add_metal(scene, block, {0.9f, 0.7f, 0.4f}, 0.3f);
    tests::add_surface(scene, tests::make_sphere(4, 0.35f, {-0.5f, -0.4f, -0.6f}), 1).medium =
        glass(1.5f, 0);
    const Shone shone(scene, 0.01, {200000});
    const LampLight light = shone.light(1024);
    const EmitterCheck check{scene, shone.rays, {}, {}, shone.sources, {}, &light};
    std::uint64_t traced = 0, key = 7;
    double squares = 0;
    const std::array<Receiver, 4> places{{{{-0.6f, -0.2f, -0.999f}, {0, 0, 1}},
                                          {{-0.1f, 0.6f, -0.999f}, {0, 0, 1}},
                                          {{0.7f, 0.2f, 0.999f}, {0, 0, -1}},
                                          {{-0.999f, 0, 0.1f}, {1, 0, 0}}}};
    for (const Receiver& place : places) {
        const double truth = trace_irradiance(check, place, 20000, 3, ++key, traced).y;
        const double found = receive_light(light, place, key, traced)[0].y;
        squares += (found / truth - 1) * (found / truth - 1) / 4;
    }
    EXPECT_LT(std::sqrt(squares), 0.02);
}

}  // namespace
}  // namespace opaline::bake
