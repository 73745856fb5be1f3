// Elements of particles and rows that gather them: how even a furnace box is, how sharp a caustic.
// Prints both tables as markdown; half a minute.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include "bake/emitters/receiver_light.h"
#include "bake/emitters/trace_particles.h"
#include "tests/bake/emitters/lamp_scenes.h"
#include "tests/bench/bench.h"

namespace opaline::bake {
namespace {

struct Traced {
    Traced(const formats::Scene& given, std::uint32_t particles, double fixed_area = 0)
        : scene(given),
          rays(tests::build_rays(scene)),
          sources(tests::all_sources(scene)),
          layout(scene, 4 * reflecting_area(scene) / particles) {
        std::uint64_t traced = 0;
        deposits = trace_particles(scene, rays, sources[0], layout, {particles, 0, 0, fixed_area},
                                   Context{}, traced)
                       .all;
        elements.push_back(layout.join(deposits, kGatheredElements));
    }
    const formats::Scene& scene;
    RayScene rays;
    std::vector<LampSources> sources;
    ElementLayout layout;
    std::vector<ElementDeposit> deposits;
    std::vector<ElementLight> elements;
};

struct Evenness {
    double mean = 0, rms = 0, largest = 0, corners = 0;
};

// Rows of a furnace's vertices, irradiance 2, relative to it. `corners`: the mean of the eight.
Evenness measure_rows(const Traced& traced, std::uint32_t samples) {
    const auto receivers = tests::receivers_of(traced.scene);
    const LampLight light{
        traced.scene, traced.rays, traced.sources, traced.layout, traced.elements, samples, 0};
    std::uint64_t rays = 0;
    const auto rows = make_lamp_rows(light, receivers[0], 1, Context{}, rays);
    Evenness even;
    int corners = 0;
    for (std::size_t r = 0; r < rows[0].size(); ++r) {
        const double error = std::numbers::pi * static_cast<double>(rows[0][r].g) / 2 - 1;
        const glm::vec3 at = glm::abs(receivers[0].outside[r].origin);
        even.mean += error;
        even.rms += error * error;
        even.largest = std::max(even.largest, std::abs(error));
        if (std::min({at.x, at.y, at.z}) > 0.99f) even.corners += error, ++corners;
    }
    const auto n = static_cast<double>(rows[0].size());
    return {even.mean / n, std::sqrt(even.rms / n), even.largest, even.corners / corners};
}

void print_furnace() {
    std::printf(
        "| particles | faces | rows, mean | RMS | largest | corners | groups |\n"
        "|---:|---:|---:|---:|---:|---:|---:|\n");
    formats::Scene scene;
    tests::add_surface(scene, tests::make_cube(8, true), 0.5f, std::numbers::inv_pi_v<float>);
    for (const std::uint32_t particles : {20000u, 100000u, 400000u, 1600000u}) {
        const Traced traced(scene, particles);
        const std::size_t face = traced.layout.size() / 6;
        double worst = 0;
        for (std::size_t f = 0; f < 6; ++f) {
            double sum = 0;
            for (std::size_t i = f * face; i < (f + 1) * face; ++i)
                sum += traced.deposits[i].power.x;
            worst = std::max(worst, std::abs(sum / 8 - 1));
        }
        std::size_t groups = 0;
        for (std::size_t i = 0; i < traced.layout.size(); ++i)
            groups += traced.elements[0].together[i] == i ? 1 : 0;
        const Evenness even = measure_rows(traced, 1024);
        std::printf("| %u | %.2f %% | %+.2f %% | %.2f %% | %.2f %% | %+.2f %% | %zu |\n", particles,
                    100 * worst, 100 * even.mean, 100 * even.rms, 100 * even.largest,
                    100 * even.corners, groups);
    }
}

// Below a ball of rough glass, under a small lamp: RMS error of the caustic over its RMS, against
// 16 million particles in elements of 1 to 2 cm.
void print_caustic() {
    formats::Scene scene;
    tests::add_surface(scene, tests::make_quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}), 0);
    tests::add_surface(scene, tests::make_quad({-0.1f, -0.1f, 2}, {0, 0.2f, 0}, {0.2f, 0, 0}), 0,
                       1);
    formats::Medium glass;
    glass.sigma_s = glass.sigma_a = {0, 0, 0};
    glass.eta = 1.5f;
    glass.roughness = 0.3f;
    tests::add_surface(scene, tests::make_sphere(6, 0.3f, {0, 0, 0.4f}), 1).medium = glass;
    const RayScene rays = tests::build_rays(scene);
    const auto sources = tests::all_sources(scene);
    const ElementLayout layout(scene, 1e-4);
    const std::size_t floor = layout.element({1, 0}, {1, 0, 0});
    std::uint64_t traced = 0;
    const auto caustic_of = [&](const ParticleRun& run, const JoinRule& rule) {
        return layout
            .join(trace_particles(scene, rays, sources[0], layout, run, Context{}, traced).caustic,
                  rule)
            .irradiance;
    };
    const auto truth = caustic_of({16000000, 0, 5, 1e-9}, {});
    std::printf(
        "\n| particles | share of footprints | limited by the gradient | not limited |\n"
        "|---:|---:|---:|---:|\n");
    for (const std::uint32_t particles : {20000u, 100000u, 400000u}) {
        for (const double share : {1.0, 0.25, 0.0625, 0.0156}) {
            std::printf("| %u | %g |", particles, share);
            for (const double limit : {0.7, std::numeric_limits<double>::infinity()}) {
                const auto found =
                    caustic_of({particles, 0, 0, 0, nullptr, false, limit}, {share, 16});
                double error = 0, all = 0;
                for (std::size_t i = 0; i < floor; ++i) {
                    const double exact{truth[i].x}, difference = double{found[i].x} - exact;
                    error += difference * difference;
                    all += exact * exact;
                }
                std::printf(" %.1f %% |", 100 * std::sqrt(error / all));
            }
            std::printf("\n");
        }
    }
}

}  // namespace
}  // namespace opaline::bake

int opaline::tests::particle_table(int, char**) {
    opaline::bake::print_furnace();
    opaline::bake::print_caustic();
    return 0;
}
