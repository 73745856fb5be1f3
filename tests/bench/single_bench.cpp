// Single scattering by light-space maps against rays along the same directions. Both sides
// alternate within one run: these machines are noisy.

#include <benchmark/benchmark.h>

#include <chrono>
#include <utility>
#include <vector>

#include "bake/effects/single/light_maps.h"
#include "bake/effects/single/ray_single.h"
#include "bake/effects/single/texel_directions.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "tests/bench/dented_ball.h"

namespace opaline::bake {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

// Every n-th block of a set, each of its directions a texel of its own.
DirectionSet thinned(const DirectionSet& all, std::size_t blocks) {
    DirectionSet set;
    set.cubemap_size = all.cubemap_size;
    for (std::uint32_t b = 0; b < blocks; ++b) {
        DirectionBlock block = all.blocks[b * all.blocks.size() / blocks];
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            block.texel[lane] = b * RayPacket::kSize + lane;
            set.inverse_solid_angle.push_back(all.inverse_solid_angle[0]);
        }
        set.blocks.push_back(block);
    }
    return set;
}

void maps_against_rays(benchmark::State& state) {
    const formats::Scene scene = tests::make_dented_ball();
    const RayScene rays = std::move(RayScene::build(scene, 0)).value();
    const auto points = make_body_points(scene, make_vertex_receivers(scene));
    const SingleMedium medium = make_single_medium(scene, 0, 8);
    const BodyMesh mesh = make_body_mesh(scene, rays, 0, {});
    const DirectionSet set = thinned(make_texel_directions(16), 2);
    const auto shares = texel_shares(set);
    const std::size_t texels = set.inverse_solid_angle.size();
    std::vector<float> row(3 * texels);
    Context context;
    context.threads = 1;
    double maps = 0, setup = 0, traced = 0;
    std::size_t runs = 0, receivers = 0;
    for (auto _ : state) {
        // Nodes are placed once for all directions of a bake.
        auto start = Clock::now();
        benchmark::DoNotOptimize(
            gather_single_rows(rays, mesh, light_view_size(mesh), {}, medium, points, context));
        setup += seconds_since(start);
        start = Clock::now();
        benchmark::DoNotOptimize(
            gather_single_rows(rays, mesh, light_view_size(mesh), set, medium, points, context));
        maps += seconds_since(start);
        ++runs;
        start = Clock::now();
        for (std::size_t i = 0; i < points.size(); i += 64, ++receivers) {
            gather_single(rays, set, shares, medium, points[i], row);
            benchmark::DoNotOptimize(row.data());
        }
        traced += seconds_since(start);
    }
    const double one_map = (maps - setup) / static_cast<double>(runs * texels);
    const double all_rays =
        traced / static_cast<double>(receivers * texels) * static_cast<double>(points.size());
    state.counters["ms/direction"] = 1e3 * one_map;
    state.counters["ns/node"] = 1e9 * one_map / static_cast<double>(8 * points.size());
    state.counters["rays/maps"] = all_rays / one_map;
}
BENCHMARK(maps_against_rays)->Unit(benchmark::kMillisecond)->MinTime(5);

}  // namespace
}  // namespace opaline::bake
