// Light of volumes on surfaces, against closed forms and paths.
#include "bake/exchange/lamps/glow_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/effects/effects.h"
#include "bake/effects/emitters/emitter_error.h"
#include "bake/effects/volumes/bake_volumes.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "tests/bake/lamps/lamp_scenes.h"
#include "tests/support/volumes.h"

namespace opaline::bake {
namespace {

constexpr double kFlameSize = 0.02;  // [m]
const glm::vec3 kFlameColor(4, 2, 1);

// A small flame at the scene's origin that hardly absorbs.
formats::Volume small_flame() {
    formats::Volume flame =
        tests::make_volume(tests::make_blob(kFlameSize, kFlameSize / 4), 1, 0, 0);
    tests::make_it_glow(flame, kFlameColor);
    flame.sigma_t = {1e-4f, 1e-4f, 1e-4f};
    return flame;
}

// 4 pi times the integral of its radiance per metre.
glm::dvec3 flame_power() {
    return 4 * std::numbers::pi * std::pow(2 * std::numbers::pi, 1.5) * std::pow(kFlameSize, 3) *
           glm::dvec3(kFlameColor);
}

// Its light as a bake has it.
struct BakedFlame {
    formats::Scene scene;
    RayScene rays;
    formats::Volumes volumes;
    GlowLight light;
};

std::unique_ptr<BakedFlame> bake_flame(formats::Scene scene) {
    BakeOptions options;
    options.quality = Quality::preview;
    options.cubemap_size = 8;
    const Knobs knobs = *resolve_knobs(all_effects(), options);
    RayScene rays = tests::build_rays(scene);
    StageLog log;
    auto volumes = *bake_volumes({scene, rays, plan_volumes(scene, knobs).layouts, knobs}, {}, log);
    auto baked = std::make_unique<BakedFlame>(
        BakedFlame{std::move(scene), std::move(rays), std::move(volumes), {}});
    baked->light = *make_glow_light(baked->scene, 0, baked->volumes.view(), 0, 1);
    return baked;
}

glm::dvec3 light_at_point(const BakedFlame& flame, const Receiver& receiver,
                          std::uint32_t samples = 1024) {
    std::uint64_t rays = 0;
    return glow_irradiance(flame.light, flame.rays, receiver, samples, {0.3f, 0.8f}, rays);
}

formats::Scene flame_alone() {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.volumes = {small_flame()};
    return scene;
}

void expect_light(const glm::dvec3& found, const glm::dvec3& truth, double tolerance) {
    for (int band = 0; band < 3; ++band) {
        EXPECT_NEAR(found[band] / truth[band], 1, tolerance) << "band " << band;
    }
}

// cos / r^2 is harmonic: around a ball of any radius its mean is that at the centre.
TEST(GlowLight, ABallOfFlameGivesItsPowerOverTheSphereTimesTheCosine) {
    const auto flame = bake_flame(flame_alone());
    for (const double distance : {0.2, 1.0, 5.0}) {
        const glm::dvec3 down = glm::normalize(glm::dvec3(0.6, -1, 0.2));
        const glm::dvec3 truth =
            flame_power() * -down.y / (4 * std::numbers::pi * distance * distance);
        expect_light(light_at_point(*flame, {glm::vec3(distance * down), {0, 1, 0}}), truth, 0.01);
    }
    EXPECT_EQ(light_at_point(*flame, {{0, -1, 0}, {0, -1, 0}}), glm::dvec3(0));
}

// Floats of the world are 0.06 m apart there.
TEST(GlowLight, IsTheSameFarFromTheOriginOfTheWorld) {
    const Receiver below{{0.1f, -0.3f, 0}, {0, 1, 0}};
    const glm::dvec3 near = light_at_point(*bake_flame(flame_alone()), below);
    formats::Scene scene = flame_alone();
    scene.origin = {1e6, -1e6, 3e5};
    expect_light(light_at_point(*bake_flame(std::move(scene)), below), near, 1e-3);
}

TEST(GlowLight, InsideOfTheBallItIsOfTheFlameAlone) {
    // At the centre of a blob all directions have the radiance of half a line through it.
    const auto flame = bake_flame(flame_alone());
    const double half_line = kFlameSize * std::sqrt(std::numbers::pi / 2);
    expect_light(light_at_point(*flame, {{0, 0, 0}, {0, 1, 0}}),
                 std::numbers::pi * half_line * glm::dvec3(kFlameColor), 0.02);
}

TEST(GlowLight, AnEdgeBeforeTheMiddleOfTheFlameHalvesIt) {
    formats::Scene scene = flame_alone();
    scene.primitives.push_back(tests::make_quad({0, -0.5f, -1}, {1, 0, 0}, {0, 0, 2}));
    const auto flame = bake_flame(std::move(scene));
    const glm::dvec3 truth = 0.5 * flame_power() / (4 * std::numbers::pi);
    expect_light(light_at_point(*flame, {{0, -1, 0}, {0, 1, 0}}, 4096), truth, 0.015);
}

TEST(GlowLight, SmokeBetweenAbsorbsByBeersLaw) {
    formats::Scene scene = flame_alone();
    // 0.2 m thick around y = 0.2 - 0.7, even inside.
    formats::Volume smoke = tests::make_volume(
        tests::sample_grid({0.3, 0.1, 0.3}, 0.02, [](glm::dvec3) { return 1.0; }), 1, 0, 0);
    smoke.sigma_t = {2, 5, 10};
    smoke.density.to_scene[3] = glm::dvec4(0, -0.5, 0, 1);
    scene.volumes.push_back(std::move(smoke));
    const auto flame = bake_flame(std::move(scene));
    // Density falls to 0 within a voxel of both sides: 11 voxels in all.
    const glm::dvec3 depth = 0.22 * glm::dvec3(2, 5, 10);
    expect_light(light_at_point(*flame, {{0, -1, 0}, {0, 1, 0}}),
                 glm::exp(-depth) * flame_power() / (4 * std::numbers::pi), 0.02);
}

TEST(GlowLight, ParticlesTakeAllPowerToTheWallsAround) {
    formats::Scene scene = flame_alone();
    scene.primitives.push_back(tests::make_cube(1, true));
    scene.materials[0].base_color = {0, 0, 0};
    const RayScene rays = tests::build_rays(scene);
    const LampSources sources = make_lamp_sources(scene, {.name = "flame", .volume = 0, .glow = 0});
    const ElementLayout layout(scene, 0.1);
    std::uint64_t traced = 0;
    const ParticleLight light =
        trace_particles(scene, rays, sources, layout, {.particles = 20000}, {}, traced);
    glm::dvec3 sum(0), lower(0);
    for (std::size_t i = 0; i < light.all.size(); ++i)
        sum += light.all[i].power;
    expect_light(sum, flame_power(), 0.002);
    // Absorbed on the way, 0.5 m along the axes and more toward corners.
    scene.volumes[0].sigma_t = {1, 1, 1};
    const DensitySpace space = make_density_space(scene);
    ParticleRun dimmed{.particles = 20000};
    dimmed.volumes = &space;
    const ParticleLight less = trace_particles(scene, rays, sources, layout, dimmed, {}, traced);
    for (const ElementDeposit& deposit : less.all)
        lower += deposit.power;
    EXPECT_LT(lower.x, sum.x);
    EXPECT_GT(lower.x, sum.x * std::exp(-kFlameSize * std::sqrt(2 * std::numbers::pi)));
}

TEST(GlowLight, RowsAgreeWithPathsThroughSmokeThatScatters) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, 4), 0);
    formats::Volume fire = tests::make_volume(tests::make_blob(0.2, 0.05), 1, 0, 0.3f);
    fire.sigma_t = {2, 4, 8};
    fire.albedo = {0.8f, 0.6f, 0.4f};
    tests::make_it_glow(fire, {3, 2, 1});
    scene.volumes = {fire};
    const auto baked = bake_flame(std::move(scene));
    const DensitySpace space = make_density_space(baked->scene);
    const auto grids = make_glowing_grids(baked->scene, {0});
    const auto receivers = tests::receivers_of(baked->scene);
    const std::vector<LampSources> sources{make_lamp_sources(baked->scene, {.volume = 0})};
    const EmitterCheck check{baked->scene, baked->rays, receivers, {},   sources,
                             {},           nullptr,     &space,    grids};
    std::uint64_t traced = 0;
    for (const float x : {0.0f, 0.7f, 1.6f}) {
        const Receiver floor{{x, -0.999f, 0.1f}, {0, 1, 0}};
        const glm::dvec3 truth = trace_irradiance(check, collect_true_sources(check.sources), floor,
                                                  20000, 3, 5, traced);
        expect_light(light_at_point(*baked, floor), truth, 0.05);
    }
}

}  // namespace
}  // namespace opaline::bake
