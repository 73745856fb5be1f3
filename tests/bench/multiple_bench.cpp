// Multiple scattering: the tree against the sum over all samples, and rays shared between samples
// against rays of their own. Both sides alternate within one run: these machines are noisy.

#include <benchmark/benchmark.h>

#include <chrono>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/effects/multiple/gather_multiple.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "formats/opal/cubemap.h"
#include "tests/bench/dented_ball.h"

namespace opaline::bake {
namespace {

using Clock = std::chrono::steady_clock;
constexpr std::uint32_t kCubemap = 32, kKept = 128;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Body {
    formats::Scene scene = tests::make_dented_ball();
    RayScene rays = std::move(RayScene::build(scene, 0)).value();
    std::vector<SurfaceSample> samples;
    Context context;

    explicit Body(std::uint32_t count) : samples(sample_surface(scene, {0}, count, 0, {})) {
        context.threads = 1;
    }

    SampleTransport trace(std::size_t count, bool share_rays) const {
        return bake_sample_transport(rays, std::span(samples).first(count),
                                     {kCubemap, kKept, 1.3, share_rays}, context);
    }
};

void tree_against_all_samples(benchmark::State& state) {
    const Body body(static_cast<std::uint32_t>(state.range(0)));
    SampleTransport transport = body.trace(body.samples.size(), true);
    const ClusterTree tree =
        build_cluster_tree(body.samples, std::move(transport), kCubemap, kKept, {});
    const MediumProfile medium = make_medium_profile(*body.scene.materials[0].medium, 0, {});
    const double spacing = std::sqrt(tree.total_area / static_cast<double>(body.samples.size()));
    const GatherProfile profile = make_gather_profile(medium, spacing, 4);
    const formats::Primitive& ball = body.scene.primitives[0];
    const std::size_t size = 4 * formats::cubemap_texels(kCubemap);
    std::vector<float> one(size), other(size);
    std::vector<ClusterWeight> weights;
    double by_tree = 0, by_all = 0, wrong = 0, right = 0;
    std::size_t v = 0;
    const auto gather = [&](double tolerance, std::vector<float>& sum, double& seconds) {
        const auto start = Clock::now();
        collect_weights(tree, profile, ball.position[v], ball.normal[v], {tolerance}, weights);
        accumulate(tree, weights, sum);
        seconds += seconds_since(start);
    };
    for (auto _ : state) {
        v = (v + 997) % ball.position.size();
        gather(1e-3, one, by_tree);
        gather(0, other, by_all);
        for (std::size_t k = 0; k < size; ++k) {
            wrong += std::pow(static_cast<double>(one[k] - other[k]), 2);
            right += std::pow(static_cast<double>(other[k]), 2);
        }
    }
    state.counters["us/receiver"] = 1e6 * by_tree / static_cast<double>(state.iterations());
    state.counters["all/tree"] = by_all / by_tree;
    state.counters["L2 difference %"] = 100 * std::sqrt(wrong / right);
}
BENCHMARK(tree_against_all_samples)
    ->Arg(20000)
    ->Arg(100000)
    ->Arg(300000)
    ->Iterations(100)
    ->Unit(benchmark::kMillisecond);

void shared_against_own_rays(benchmark::State& state) {
    const Body body(static_cast<std::uint32_t>(state.range(0)));
    constexpr std::size_t kSamples = 1024;
    double shared = 0, own = 0;
    std::uint64_t shared_rays = 0, own_rays = 0;
    for (auto _ : state) {
        auto start = Clock::now();
        shared_rays += body.trace(kSamples, true).rays;
        shared += seconds_since(start);
        start = Clock::now();
        own_rays += body.trace(kSamples, false).rays;
        own += seconds_since(start);
    }
    state.counters["us/sample"] = 1e6 * shared / static_cast<double>(state.iterations() * kSamples);
    state.counters["own/shared"] = own / shared;
    state.counters["rays own/shared"] =
        static_cast<double>(own_rays) / static_cast<double>(shared_rays);
}
BENCHMARK(shared_against_own_rays)
    ->Arg(20000)
    ->Arg(300000)
    ->MinTime(3)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace opaline::bake
