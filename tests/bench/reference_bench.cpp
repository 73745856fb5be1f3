// How fast the Monte Carlo reference is. `samples` is paths per second, `efficiency` is
// 1 / (variance of one path * seconds per path), relative to the squared mean: what decides how
// long a given standard error takes. Compare within one run.
//
//   opaline_bench speed --benchmark_min_time=2
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <vector>

#include "bake/lights/builtin_environment.h"
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
}

formats::Scene make_ball(const formats::Medium& medium) {
    return tests::make_translucent_scene({tests::make_sphere(4)}, medium);
}

formats::Scene make_ball_on_floor() {
    return tests::make_scene({tests::make_sphere(4, 1, {0, 1.1f, 0}),
                              tests::make_quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, 20)});
}

formats::Medium make_forward_medium() {
    formats::Medium medium = tests::make_grey_medium(20, 0.2f);
    medium.phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    medium.phase.g = 0.8f;
    return medium;
}

// Coefficients as unlike as a red wax's. Three channels on one path, decided by a mixture of their
// densities, against a path for each channel.
formats::Medium make_coloured_medium() {
    formats::Medium medium;
    medium.sigma_s = {30, 60, 120};
    medium.sigma_a = {0.3f, 2, 12};
    medium.eta = 1.3f;
    return medium;
}

void one_channel(benchmark::State& state) {
    const auto c = static_cast<int>(state.range(0));
    formats::Medium medium = make_coloured_medium();
    const float s = glm::vec3(medium.sigma_s.r, medium.sigma_s.g, medium.sigma_s.b)[c];
    const float a = glm::vec3(medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b)[c];
    glm::dvec3 channels(0);
    channels[c] = 1;
    measure(state, *make_case(make_ball(tests::make_grey_medium(s, a)), "studio"), channels);
}
BENCHMARK(one_channel)->DenseRange(0, 2)->Unit(benchmark::kMillisecond);

void reference(benchmark::State& state, formats::Scene scene, const char* light) {
    measure(state, *make_case(std::move(scene), light));
}

#define OPALINE_REFERENCE(name, scene, light) \
    BENCHMARK_CAPTURE(reference, name, scene, light)->Unit(benchmark::kMillisecond)

OPALINE_REFERENCE(opaque, make_ball_on_floor(), "studio");
OPALINE_REFERENCE(dense, make_ball(tests::make_grey_medium(99, 1)), "white");
OPALINE_REFERENCE(dense_studio, make_ball(tests::make_grey_medium(99, 1)), "studio");
OPALINE_REFERENCE(forward, make_ball(make_forward_medium()), "studio");
OPALINE_REFERENCE(matched, make_ball(tests::make_grey_medium(20, 1, 1)), "sun:30,60");
OPALINE_REFERENCE(three_channels, make_ball(make_coloured_medium()), "studio");

}  // namespace
}  // namespace opaline::bake
