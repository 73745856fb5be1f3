#include "bake/calibration/calibration.h"

#include <algorithm>
#include <numeric>
#include <span>
#include <thread>
#include <vector>

#include "bake/calibration/bench/calibration_bench.h"
#include "bake/calibration/bench/stopwatch.h"
#include "bake/calibration/traced_collision.h"
#include "bake/encode/select_coefficients.h"
#include "bake/plan/stage_work.h"
#include "bake/scattering/half_space_medium.h"
#include "bake/scattering/half_space_walk.h"
#include "bake/scene/inspect_scene.h"
#include "bake/scene/orient_bodies.h"
#include "bake/transport/bake_openness.h"
#include "bake/transport/irradiance_transport.h"
#include "bake/truth/test_lights.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

double measure_coherent_ray(const CalibrationBench& bench, std::size_t wanted) {
    const DirectionSet directions = make_direction_set(kCalibrationCubemap);
    std::vector<float> dense(formats::cubemap_texels(kCalibrationCubemap));
    std::uint64_t traced = 0;
    const auto receivers = thinned(std::span<const Receiver>(bench.receivers), wanted);
    const Stopwatch watch;
    for (const Receiver& receiver : receivers) {
        traced += gather_irradiance(bench.rays, directions, receiver, dense);
    }
    return watch.seconds() / static_cast<double>(traced);
}

double measure_open_cell(const CalibrationBench& bench) {
    const auto nothing = RayScene::build({}, 1);
    const DirectionSet directions = make_direction_set(kCalibrationCubemap);
    std::vector<float> dense(formats::cubemap_texels(kCalibrationCubemap));
    const auto receivers = thinned(std::span<const Receiver>(bench.receivers), 48);
    const Stopwatch watch;
    for (const Receiver& receiver : receivers) {
        gather_irradiance(*nothing, directions, receiver, dense);
    }
    return watch.seconds() /
           (static_cast<double>(receivers.size()) * count_rays(kCalibrationCubemap));
}

double measure_openness(const CalibrationBench& bench) {
    const DirectionSet directions = make_sparse_direction_set(8, 0);
    // Neighbours share rays, so the set must stay large.
    const auto receivers = thinned(std::span<const Receiver>(bench.receivers), 4000);
    std::uint64_t traced = 0;
    const Stopwatch watch;
    bake_openness(bench.rays, directions, receivers, one_thread(), traced);
    return watch.seconds() / static_cast<double>(receivers.size());
}

// Seconds per row: Haar transform of a cube map, selection, quantisation.
double measure_encoding(std::uint32_t bands) {
    const std::size_t texels = formats::cubemap_texels(kCalibrationCubemap);
    const Selector selector = make_selector(kCalibrationCubemap, kCalibrationKept);
    std::vector<float> row(texels * bands);
    formats::SparseRows rows = formats::make_sparse_rows(kCalibrationCubemap, 8);
    constexpr int kRows = 200;
    Stopwatch watch;
    for (int r = 0; r < kRows; ++r) {
        for (std::size_t k = 0; k < row.size(); ++k) {
            row[k] = static_cast<float>((k * 2654435761u + 97u * static_cast<unsigned>(r)) % 1021u);
        }
        if (bands == 1) {
            formats::haar_forward_cube(std::span<float>(row), kCalibrationCubemap);
        }
        formats::append_row(rows, select_coefficients(selector, row, bands));
    }
    return watch.seconds() / (kRows * static_cast<double>(texels));
}

double measure_walk_event() {
    constexpr double kAlbedo = 0.95, kEta = 1.3;
    constexpr std::uint32_t kPaths = 2048;
    const Stopwatch watch;
    walk_half_space(kAlbedo, 0, kEta, kPaths, 0, one_thread());
    return watch.seconds() / (kPaths * count_walk_events(kAlbedo, 0, kEta));
}

// Slow-down of the same rays while all other threads trace them too.
double measure_crowding(const CalibrationBench& bench, unsigned threads) {
    const double alone = measure_coherent_ray(bench, 32);
    std::vector<double> together(threads);
    std::vector<std::thread> workers;
    workers.reserve(threads);
    for (double& own : together) {
        workers.emplace_back([&bench, &own] { own = measure_coherent_ray(bench, 32); });
    }
    for (std::thread& worker : workers) {
        worker.join();
    }
    const double mean = std::accumulate(together.begin(), together.end(), 0.0) / threads;
    return std::max(1.0, mean / alone);
}

Rates measure_all(const EffectTable& effects, std::span<const TestLight> lights, unsigned threads) {
    Rates rates;
    Stopwatch watch;
    rates.encode_grey = measure_encoding(1);
    rates.encode_colour = measure_encoding(3);
    rates.walk_event = measure_walk_event();
    for (const bool is_many : {false, true}) {
        const CalibrationBench bench(is_many, lights);
        bench.side_of(rates.build_triangle) = bench.build / bench.triangles;
        bench.side_of(rates.place_receiver) =
            bench.place_receivers / static_cast<double>(bench.receivers.size());
        bench.side_of(rates.coherent_ray) = measure_coherent_ray(bench, 48);
        rates.open_cell = measure_open_cell(bench);
        bench.side_of(rates.openness) = measure_openness(bench);
        for (const EffectDescriptor& effect : effects.effects) {
            if (effect.calibrate != nullptr) {
                effect.calibrate(bench, rates);
            }
        }
        if (is_many) {
            watch.restart();
            orient_bodies(bench.scene);
            rates.orient_triangle = watch.seconds() / bench.triangles;
            watch.restart();
            inspect_scene(bench.scene);
            rates.plan_triangle = watch.seconds() / bench.triangles;
            rates.traced_collision = measure_traced_collision();
            rates.crowding = measure_crowding(bench, threads);
        }
    }
    return rates;
}

}  // namespace

Rates measure_rates(const EffectTable& effects, unsigned threads) {
    auto lights = make_test_lights(kCalibrationCubemap, 1);
    // What is left of them once they are in the user's cache.
    const Stopwatch watch;
    project_test_lights(*lights, kCalibrationCubemap);
    const double seconds = watch.seconds();
    // A disturbance can only lengthen a measurement: the shorter of two is right.
    std::vector<double> first;
    visit_rates(measure_all(effects, *lights, threads),
                [&](const char*, double rate) { first.push_back(rate); });
    Rates rates = measure_all(effects, *lights, threads);
    auto other = first.begin();
    visit_rates(rates, [&](const char*, double& rate) { rate = std::min(rate, *other++); });
    rates.test_lights = seconds;
    return rates;
}

}  // namespace opaline::bake
