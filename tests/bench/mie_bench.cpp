// Spheres a second and core; seconds of a distribution of droplets in three wavelengths. `angles`
// is the part that grows with the angles; its counter is nanoseconds for one order at one angle.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <complex>
#include <cstddef>
#include <vector>

#include "bake/mie/droplet_optics.h"
#include "bake/mie/forward_peak.h"
#include "bake/mie/refractive_index.h"
#include "bake/mie/sphere_scattering.h"

namespace {

using namespace opaline::bake;

constexpr double kDegree = 0.017453292519943295;

/// Size parameters equally spaced up to the argument; real or slightly absorbing index.
void spheres(benchmark::State& state) {
    const auto most = static_cast<double>(state.range(0));
    const std::complex<double> m(1.333, state.range(1) == 0 ? 0 : 1e-9);
    constexpr int kSpheres = 1000;
    MieSeries series;
    for (auto _ : state) {
        double sum = 0;
        for (int i = 0; i < kSpheres; ++i) {
            sum += sphere_efficiencies(most * (i + 0.5) / kSpheres, m, series).q_ext;
        }
        benchmark::DoNotOptimize(sum);
    }
    state.counters["spheres_per_second"] = benchmark::Counter(
        static_cast<double>(kSpheres * state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(spheres)->ArgNames({"x", "absorbing"})->ArgsProduct({{10, 100, 1000}, {0, 1}});

void angles(benchmark::State& state) {
    const auto x = static_cast<double>(state.range(0));
    const AngleGrid grid = make_angle_grid(0.02 * kDegree, 0.1 * kDegree, 0.01);
    std::vector<double> sum(grid.size(), 0.0);
    MieSeries series;
    expand_sphere(x, {1.333, 1e-9}, series);
    for (auto _ : state) {
        add_intensities(series, grid, 1, sum);
        benchmark::DoNotOptimize(sum.data());
    }
    state.counters["ns_per_order_and_angle"] = benchmark::Counter(
        static_cast<double>(state.iterations()) * static_cast<double>(grid.size()) *
            static_cast<double>(series.a.size()) * 1e-9,
        benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}
BENCHMARK(angles)->ArgName("x")->Arg(10)->Arg(100)->Arg(1000);

/// The argument is the effective radius in tenths of a micrometre, then the number of threads.
void droplets(benchmark::State& state) {
    const DropletDistribution distribution{3e8, static_cast<double>(state.range(0)) * 1e-7, 2};
    Context context;
    context.threads = static_cast<unsigned>(state.range(1));
    double worst = 0;
    for (auto _ : state) {
        for (const double wavelength : {650e-9, 550e-9, 450e-9}) {
            const auto index = refractive_index(Substance::water, wavelength).value();
            const auto optics =
                average_droplets(distribution, wavelength, index, {}, context).value();
            worst = std::max(worst, optics.error.phase_rms);
        }
    }
    state.counters["rms_percent"] = 100 * worst;
}
BENCHMARK(droplets)
    ->ArgNames({"r_e", "threads"})
    ->ArgsProduct({{20, 70, 140, 280}, {1, 2}})
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);

/// What follows from a phase function: the split, both sets of moments, two scatterings.
void forward_peak(benchmark::State& state) {
    const auto optics =
        average_droplets({}, 550e-9, {1.333, 1.96e-9}, {.size_step = 0.3}, {}).value();
    for (auto _ : state) {
        const PeakSplit split = split_peak(optics.phase, find_peak_angle(optics.phase));
        benchmark::DoNotOptimize(table_moments(split.peak, kGlowMoments));
        benchmark::DoNotOptimize(
            convolve_with_itself(split.rest, kConvolutionMoments, optics.phase.angle));
    }
}
BENCHMARK(forward_peak)->Unit(benchmark::kMillisecond);

}  // namespace
