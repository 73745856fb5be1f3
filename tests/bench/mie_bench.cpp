// Spheres a second and core; seconds of a distribution of droplets in three wavelengths.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <complex>
#include <cstddef>

#include "bake/physics/mie/droplet_optics.h"
#include "bake/physics/mie/refractive_index.h"
#include "bake/physics/mie/sphere_scattering.h"

namespace {

using namespace opaline::bake;

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

/// The argument is the effective radius in tenths of a micrometre.
void droplets(benchmark::State& state) {
    const DropletDistribution distribution{3e8, static_cast<double>(state.range(0)) * 1e-7, 2};
    Context context;
    context.threads = 1;
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
    ->ArgName("r_e")
    ->Arg(70)
    ->Arg(140)
    ->Arg(280)
    ->Unit(benchmark::kSecond)
    ->UseRealTime()
    ->Iterations(1);

}  // namespace
