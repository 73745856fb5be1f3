// Particles through scenes: form factors, energy, errors by level.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "bake/exchange/lamps/particle_start.h"
#include "bake/exchange/lamps/trace_particles.h"
#include "tests/bake/lamps/lamp_scenes.h"

namespace opaline::bake {
namespace {

// Closed form (2 / pi) (ln sqrt(4/3) + 2 sqrt 2 atan(1 / sqrt 2) - 2 atan 1).
constexpr double kFormFactor = 0.19982490;

using Power = std::vector<ElementDeposit>;

Power trace(const formats::Scene& scene, const ElementLayout& layout, ParticleRun run,
            unsigned threads = 1) {
    const RayScene rays = tests::build_rays(scene);
    Context context;
    context.threads = threads;
    std::uint64_t traced = 0;
    Power power =
        trace_particles(scene, rays, tests::all_sources(scene).at(0), layout, run, context, traced)
            .all;
    EXPECT_GE(traced, run.particles);
    return power;
}

// Of elements first ... end - 1, red.
double sum_of(const Power& power, std::size_t first, std::size_t end) {
    return std::accumulate(power.begin() + static_cast<std::ptrdiff_t>(first),
                           power.begin() + static_cast<std::ptrdiff_t>(end), 0.0,
                           [](double sum, const ElementDeposit& of) { return sum + of.power.x; });
}

/// RMS error of irradiance on the upper square over RMS irradiance, at 96 x 96 points.
double relative_error(const formats::Scene& scene, const ElementLayout& layout,
                      const Power& power) {
    const std::vector<glm::vec3> irradiance = layout.join(power).irradiance;
    double error = 0, square = 0;
    for (int i = 0; i < 96; ++i) {
        for (int j = 0; j < 96; ++j) {
            // The quad's sides are y, then x; its triangles (0, 1, 3) and (0, 3, 2).
            const double s = (i + 0.5) / 96, t = (j + 0.25) / 96;
            const bool is_first = s >= t;
            const glm::dvec3 weights =
                is_first ? glm::dvec3(1 - s, s - t, t) : glm::dvec3(1 - t, s, t - s);
            const std::size_t element = layout.element({1, is_first ? 0u : 3u}, weights);
            const double exact = tests::square_irradiance(t, s);
            const double found = double{irradiance[element].x};
            error += (found - exact) * (found - exact);
            square += exact * exact;
        }
    }
    EXPECT_EQ(scene.primitives.size(), 2u);
    return std::sqrt(error / square);
}

void expect_near_the_best_level(std::uint32_t particles, double expected, double tolerance) {
    const formats::Scene scene = tests::parallel_squares();
    const ElementLayout layout(scene, 0.5 / 4096);
    const std::size_t upper = layout.size() / 2;
    const Power by_footprint = trace(scene, layout, {particles});
    const double received = sum_of(by_footprint, upper, layout.size());
    EXPECT_NEAR(received, kFormFactor, 3 * std::sqrt(0.2 * 0.8 / particles));
    double best = 1;
    for (int level = 0; level < 7; ++level) {
        const Power fixed = trace(scene, layout, {particles, 0, 0, 0.5 / (1 << (2 * level))});
        // Levels change where power goes, not how much there is.
        EXPECT_NEAR(sum_of(fixed, upper, layout.size()), received, 1e-12);
        best = std::min(best, relative_error(scene, layout, fixed));
    }
    const double error = relative_error(scene, layout, by_footprint);
    ::testing::Test::RecordProperty("by_footprint", std::to_string(error));
    ::testing::Test::RecordProperty("best_level", std::to_string(best));
    EXPECT_LE(error, 1.15 * best);
    EXPECT_NEAR(error, expected, tolerance);
}

TEST(ParticleRadiosity, BetweenParallelSquaresErrsNoMoreThanTheBestLevel) {
    expect_near_the_best_level(20000, 0.08, 0.02);
}

TEST(ParticleRadiosity, ErrorFallsAsTheFourthRootOfTheirNumber) {
    expect_near_the_best_level(400000, 0.04, 0.01);
}

// Irradiance on the upper square is as noisy if it is one quad as if it is 8192 small triangles:
// these join to clusters. Each by itself would take four particles and err by half.
TEST(ParticleRadiosity, SmallTrianglesAreNoNoisierThanLargeOnes) {
    const std::uint32_t cells = 64, particles = 100000;
    std::array<double, 2> error{};
    for (std::size_t i = 0; i < 2; ++i) {
        const formats::Scene scene = tests::parallel_squares(i == 0 ? 1 : cells);
        const ElementLayout layout(scene, 0.5 / 4096);
        const std::vector<glm::vec3> irradiance =
            layout.join(trace(scene, layout, {particles})).irradiance;
        double square = 0;
        for (std::uint32_t q = 0; q < cells * cells; ++q) {
            // The middle of a triangle of the dense mesh: the quad's sides are y, then x.
            const glm::dvec2 at((q % cells + 2.0 / 3) / cells, (q / cells + 1.0 / 3) / cells);
            const glm::dvec3 weights = i == 1         ? glm::dvec3(1.0 / 3)
                                       : at.x >= at.y ? glm::dvec3(1 - at.x, at.x - at.y, at.y)
                                                      : glm::dvec3(1 - at.y, at.x, at.y - at.x);
            const std::uint32_t first = i == 1 ? 6 * q : at.x >= at.y ? 0 : 3;
            const double found = double{irradiance[layout.element({1, first}, weights)].x};
            const double exact = tests::square_irradiance(at.y, at.x);
            square += (found / exact - 1) * (found / exact - 1);
        }
        error[i] = std::sqrt(square / (cells * cells));
    }
    EXPECT_NEAR(error[1], error[0], 0.25 * error[0]);
    EXPECT_LT(error[0], 0.08);
}

// A spot below the ceiling shines down: the ceiling has the light of bounces alone, whose
// footprints are larger [Suykens2001, 4.2].
TEST(ParticleRadiosity, CeilingLitByBouncesHasCoarserElementsThanTheFloor) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(1, true), 0.6f);
    scene.lights.push_back({.type = formats::Light::Type::spot,
                            .name = "",
                            .position = {0, 0, 0.5f},
                            .direction = {0, 0, -1},
                            .inner_cone = 0.3f,
                            .outer_cone = 0.6f});
    const std::uint32_t particles = 100000;
    const ElementLayout layout(scene, 4 * reflecting_area(scene) / particles);
    const ElementLight light = layout.join(trace(scene, layout, {particles}));
    // Faces of the cube by axis: the last two are z = -1 and z = 1.
    const std::size_t face = layout.size() / 6;
    const auto groups = [&](std::size_t of_face) {
        std::size_t count = 0;
        for (std::size_t i = of_face * face; i < (of_face + 1) * face; ++i)
            count += light.together[i] == i ? 1 : 0;
        return count;
    };
    EXPECT_GE(groups(4), 2 * groups(5));
}

formats::Scene closed_room(formats::Light light) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(1, true), 0);
    scene.lights.push_back(std::move(light));
    return scene;
}

TEST(ParticleRadiosity, AllPowerOfLightsArrivesInAClosedRoom) {
    using formats::Light;
    Light spot{.type = Light::Type::spot,
               .name = "",
               .direction = {0, 0, 1},
               .inner_cone = 0.2f,
               .outer_cone = 0.9f};
    Light sun{.type = Light::Type::directional, .name = "", .direction = {0, 0, 1}};
    for (const Light& light : {Light{.name = "", .position = {0.3f, 0, 0}}, spot}) {
        const formats::Scene scene = closed_room(light);
        const ElementLayout layout(scene, 0.1);
        const Power power = trace(scene, layout, {50000});
        const double expected = light_power(tests::all_sources(scene)[0], light).x;
        EXPECT_NEAR(sum_of(power, 0, power.size()), expected, 0.01 * expected);
    }
    // From outside, on the back of the room's walls, which reflects nothing and has no elements.
    const formats::Scene scene = closed_room(sun);
    const ElementLayout layout(scene, 0.1);
    EXPECT_EQ(sum_of(trace(scene, layout, {1000}), 0, layout.size()), 0);
}

TEST(ParticleRadiosity, SunOnAFloorGivesItsLuxTimesTheArea) {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({0, 0, 0}, {3, 0, 0}, {0, 2, 0}), 0.5f);
    scene.lights.push_back({.type = formats::Light::Type::directional,
                            .name = "",
                            .intensity = {10, 10, 10},
                            .direction = glm::normalize(glm::vec3(0, 3, -4))});
    const ElementLayout layout(scene, 0.5);
    EXPECT_NEAR(sum_of(trace(scene, layout, {100000}), 0, layout.size()), 10 * 6 * 0.8, 0.5);
}

TEST(ParticleStart, PowerOfAllIsTheLampsAndRangeDims) {
    formats::Scene scene = tests::parallel_squares();
    scene.materials[0].double_sided = true;
    const auto sources = tests::all_sources(scene);
    const StartTable table = make_start_table(sources[0]);
    double sum = 0;
    int up = 0;
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Particle p = start_particle(table, {}, {1000}, i);
        sum += p.power.x;
        up += p.direction.z > 0 ? 1 : 0;
        EXPECT_NEAR(glm::length(p.direction), 1, 1e-12);
        EXPECT_EQ(p.dimming(5), 1);
    }
    EXPECT_NEAR(sum, 2, 1e-5);
    EXPECT_NEAR(up, 500, 60);
    Particle dimmed;
    dimmed.range = 2;
    EXPECT_NEAR(dimmed.dimming(1), 15.0 / 16, 1e-12);
    EXPECT_EQ(dimmed.dimming(2), 0);
}

}  // namespace
}  // namespace opaline::bake
