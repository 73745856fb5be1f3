// How fast the Monte Carlo reference is. `samples` is paths per second, `efficiency` is
// 1 / (variance of one path * seconds per path), relative to the squared mean: what decides how
// long a given standard error takes. Compare within one run.
//
//   opaline_bench speed --benchmark_min_time=2
//
// What was tried, as ratios of efficiency (after / before, two busy cores):
// - Russian roulette below a throughput of 1 instead of 0.1: 1.05 (dense, white), 1.65 (dense,
//   studio), 1.0 (g = .8), 1.3 (matched, sun), 1.35 (three channels); so in bodies. Below
//   0.5: 1.15, 1.15, 0.95, 1.4, 1.25, 1.0; below 0.02: 0.9, 0.85, 1.0, 0.95, 0.9, 1.0 (opaque).
// - log(1 - u) for log1p(-u), which has the same value; two exponentials instead of three, none in
//   grey media; frames without square roots [Duff2017]: together 1.2 in media, 1.0 at surfaces.
// - Three channels on one path are 1.5 times as efficient as each channel by itself.
// - A grid of lower bounds on the distance to surfaces, so that shorter flights trace no ray, and
//   no channel drawn in grey media: 1.4 (dense, white), 1.3 (dense, studio), 1.2 (g = .8), 1.1 (one
//   channel), 1.05 (three channels, too dense for the grid), 1.0 (matched; opaque; a coloured body
//   of 10 free paths a radius, spot-3k, whose walks stay near its surface). The walks of coloured
//   media are the same bit by bit.
// - A ball around the walk from Embree's nearest-surface query instead of the grid: 0.3. One query
//   costs as much as tens of rays.
// Before the grid, a dense medium took 36 % of its time for rays, 13 % for logarithms, sines and
// exponentials, half for random numbers and arithmetic. Packets of rays and wavefronts were tried
// and lost: RESULTS.md, "Monte Carlo reference".
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "bake/environment/builtin_environment.h"
#include "bake/reference/reference_image.h"
#include "bake/reference/reference_receivers.h"
#include "tests/support/media.h"

namespace opaline::bake {
namespace {

/// A scene under a light, receivers, and which light of theirs is asked for.
struct Case {
    formats::Scene input;
    formats::Environment light;
    std::unique_ptr<ReferenceScene> scene;
    LightSampler sampler;
    std::vector<ReferenceReceiver> receivers;
};

std::unique_ptr<Case> make_case(formats::Scene input, const char* light) {
    auto made = std::make_unique<Case>();
    made->input = std::move(input);
    made->light = make_environment(light).value();
    made->scene = std::make_unique<ReferenceScene>(make_reference_scene(made->input, 0).value());
    made->sampler = make_light_sampler(made->light, glm::mat3(1.0f));
    made->receivers = choose_receivers(*made->scene, 64, 0, std::nullopt);
    return made;
}

// One thread, so that nothing else on the machine is measured. `channels`: those that count.
void measure(benchmark::State& state, const Case& of, glm::dvec3 channels = glm::dvec3(1)) {
    const PathSpace space{*of.scene, of.sampler, {}};
    EstimateOptions options;
    options.samples = 64;
    Context context;
    context.threads = 1;
    std::vector<Moments> moments(of.receivers.size());
    double events = 0;
    for (auto _ : state) {
        const auto estimate = estimate_receivers(space, of.receivers, options, context);
        options.first += options.samples;
        for (std::size_t i = 0; i < moments.size(); ++i) {
            moments[i].merge(estimate->pixel[i]);
        }
        events += static_cast<double>(estimate->events);
    }
    double variance = 0, square = 0, paths = 0;
    for (const Moments& m : moments) {
        variance += glm::dot(channels, m.variance_of_mean() * m.count);
        square += glm::dot(channels, m.mean * m.mean);
        paths += m.count;
    }
    using benchmark::Counter;
    state.counters["samples"] = Counter(paths, Counter::kIsRate);
    state.counters["events"] = Counter(events, Counter::kIsRate);
    // Paths per second over the relative variance of one.
    state.counters["efficiency"] = Counter(paths * square / variance, Counter::kIsRate);
    state.counters["relative_deviation"] = std::sqrt(variance / square);
}

formats::Scene make_ball(const formats::Medium& medium) {
    return tests::make_translucent_scene({tests::make_sphere(4)}, medium);
}

void OpaqueSceneUnderStudio(benchmark::State& state) {
    tests::Scene scene =
        tests::make_scene({tests::make_sphere(4, 1, {0, 1.1f, 0}),
                           tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 20)});
    measure(state, *make_case(std::move(scene), "studio"));
}
BENCHMARK(OpaqueSceneUnderStudio)->Unit(benchmark::kMillisecond);

void DenseMediumUnderWhite(benchmark::State& state) {
    measure(state, *make_case(make_ball(tests::make_grey_medium(99, 1)), "white"));
}
BENCHMARK(DenseMediumUnderWhite)->Unit(benchmark::kMillisecond);

void DenseMediumUnderStudio(benchmark::State& state) {
    measure(state, *make_case(make_ball(tests::make_grey_medium(99, 1)), "studio"));
}
BENCHMARK(DenseMediumUnderStudio)->Unit(benchmark::kMillisecond);

void ForwardScatteringUnderStudio(benchmark::State& state) {
    formats::Medium medium = tests::make_grey_medium(20, 0.2f);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = 0.8f;
    measure(state, *make_case(make_ball(medium), "studio"));
}
BENCHMARK(ForwardScatteringUnderStudio)->Unit(benchmark::kMillisecond);

void MatchedMediumUnderSun(benchmark::State& state) {
    measure(state, *make_case(make_ball(tests::make_grey_medium(20, 1, 1)), "sun:30,60"));
}
BENCHMARK(MatchedMediumUnderSun)->Unit(benchmark::kMillisecond);

// Coefficients as unlike as a red wax's. Three channels on one path, decided by a mixture of their
// densities, against a path for each channel.
formats::Medium make_coloured_medium() {
    formats::Medium medium;
    medium.sigma_s = {30, 60, 120};
    medium.sigma_a = {0.3f, 2, 12};
    medium.eta = 1.3f;
    return medium;
}

void ThreeChannelsOnOnePath(benchmark::State& state) {
    measure(state, *make_case(make_ball(make_coloured_medium()), "studio"));
}
BENCHMARK(ThreeChannelsOnOnePath)->Unit(benchmark::kMillisecond);

void OneChannelByItself(benchmark::State& state) {
    const auto c = static_cast<int>(state.range(0));
    formats::Medium medium = make_coloured_medium();
    const float s = glm::vec3(medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b)[c];
    const float a = glm::vec3(medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b)[c];
    medium.sigma_s = {s, s, s};
    medium.sigma_a = {a, a, a};
    glm::dvec3 channels(0);
    channels[c] = 1;
    measure(state, *make_case(make_ball(medium), "studio"), channels);
}
BENCHMARK(OneChannelByItself)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opaline::bake
