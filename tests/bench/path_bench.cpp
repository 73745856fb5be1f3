// Nanoseconds of a step along a path through a grid of density. `grid` is what a sample of the grid
// alone takes, at points of the same path; a march needs one for each step. `row` adds a kernel of
// two scatterings or more and e^-absorption. Fixed seed and size: a blob of 96^3 voxels, 64 paths.
#include <benchmark/benchmark.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <random>
#include <vector>

#include "bake/path_integral/grid_medium.h"
#include "bake/path_integral/path_estimate.h"
#include "bake/path_integral/zonal_table.h"

namespace {

using namespace opaline::bake;
using Grid = opaline::formats::SparseGrid<float>;
using glm::dvec3;

constexpr int kBricks = 12;
constexpr double kEdge = 1.0 / 16;  // of a voxel, in units of the blob's standard deviation

Grid make_blob() {
    Grid grid;
    grid.first_brick = glm::ivec3(-kBricks / 2);
    grid.extent = glm::ivec3(kBricks);
    grid.to_scene = glm::scale(glm::dmat4(1), dvec3(kEdge));
    for (int brick = 0; brick < kBricks * kBricks * kBricks; ++brick) {
        grid.table.push_back(static_cast<std::uint32_t>(brick));
        const glm::ivec3 first(brick % kBricks, brick / kBricks % kBricks,
                               brick / (kBricks * kBricks));
        for (int v = 0; v < static_cast<int>(Grid::kBrickVoxels); ++v) {
            const glm::ivec3 voxel =
                8 * (first + grid.first_brick) + glm::ivec3(v % 8, v / 8 % 8, v / 64);
            const dvec3 x = kEdge * dvec3(voxel);
            grid.value.push_back(static_cast<float>(std::exp(-0.5 * glm::dot(x, x))));
        }
    }
    return grid;
}

dvec3 random_direction(std::mt19937& generator) {
    std::uniform_real_distribution<double> unit(-1, 1);
    const double z = unit(generator), angle = std::numbers::pi * unit(generator);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(angle), r * std::sin(angle), z};
}

struct Bench {
    Grid grid = make_blob();
    GridMedium medium{grid, {6, 0.1}};
    MarchLimits limits{.box = grid_box(grid), .step = kEdge};
    std::vector<QuasiPath> paths;

    Bench() {
        std::mt19937 generator(1);
        for (int i = 0; i < 64; ++i) {
            const dvec3 v = random_direction(generator), l = random_direction(generator);
            paths.push_back({-1.5 * v, Turns(v, l)[0], 8});
        }
    }
};

void report(benchmark::State& state, std::size_t steps) {
    state.counters["ns_per_step"] =
        benchmark::Counter(static_cast<double>(steps) * 1e-9,
                           benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void grid(benchmark::State& state) {
    const Bench bench;
    std::vector<dvec3> points;
    for (const QuasiPath& path : bench.paths) {
        march_quasi_path(path, bench.medium, bench.limits, [&](const PathStep& step) {
            points.push_back(step.position);
            return true;
        });
    }
    std::size_t count = 0;
    for (auto _ : state) {
        double sum = 0;
        for (const dvec3& x : points) {
            sum += bench.medium(x).scattering;
        }
        benchmark::DoNotOptimize(sum);
        count += points.size();
    }
    report(state, count);
}
BENCHMARK(grid);

void march(benchmark::State& state) {
    const Bench bench;
    std::size_t count = 0;
    for (auto _ : state) {
        double sum = 0;
        for (const QuasiPath& path : bench.paths) {
            march_quasi_path(path, bench.medium, bench.limits, [&](const PathStep& step) {
                sum += step.depth;
                ++count;
                return true;
            });
        }
        benchmark::DoNotOptimize(sum);
    }
    report(state, count);
}
BENCHMARK(march);

void row(benchmark::State& state) {
    const Bench bench;
    const ZonalTable table =
        make_zonal_table(state.range(0) == 0 ? PathKernel::ray : PathKernel::source,
                         expand_henyey_greenstein(0.75, 100));
    std::size_t count = 0;
    for (auto _ : state) {
        double sum = 0;
        for (const QuasiPath& path : bench.paths) {
            const ZonalRow kernel = interpolate_row(table, glm::dot(path.turn.from, path.turn.to));
            sum += gather_along_path(path, bench.medium, bench.limits, kernel, [&](dvec3) {
                ++count;
                return 1.0;
            });
        }
        benchmark::DoNotOptimize(sum);
    }
    report(state, count);
}
BENCHMARK(row)->ArgName("source")->Arg(0)->Arg(1);

void make_table(benchmark::State& state) {
    const PhaseSeries series = expand_henyey_greenstein(0.75, 100);
    for (auto _ : state) {
        benchmark::DoNotOptimize(make_zonal_table(PathKernel::source, series));
    }
}
BENCHMARK(make_table)->Unit(benchmark::kMillisecond);

}  // namespace
