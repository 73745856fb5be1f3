#include "bake/volumes/calibrate_volumes.h"

#include <algorithm>

#include "bake/calibration/bench/stopwatch.h"
#include "bake/volumes/bake_volumes.h"
#include "bake/volumes/count_walk.h"
#include "bake/volumes/volume_knobs.h"
#include "bake/volumes/volume_work.h"
#include "formats/fill_grid.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr int kRadius = 24;  // voxels

// CPU seconds of a bake of the ball.
double measure_bake(const formats::Scene& scene, const RayScene& sky, const VolumeLayout& layout,
                    const Knobs& knobs) {
    StageLog log;
    const Stopwatch watch;
    // A bake of even density in one volume has no way to fail.
    static_cast<void>(bake_volumes({scene, sky, {&layout, 1}, knobs}, one_thread(), log));
    return watch.seconds();
}

double measure_flight(const formats::Scene& scene) {
    constexpr std::uint64_t kWalks = 1000;
    const DensitySpace space = make_density_space(scene);
    double flights = 0;
    const Stopwatch watch;
    for (std::uint64_t i = 0; i < kWalks; ++i) {
        CostRandom random(i);
        flights += count_walk(space, glm::vec3(0), random).flights;
    }
    return watch.seconds() / flights;
}

}  // namespace

formats::Scene make_calibration_volume() {
    formats::Volume volume;
    volume.name = "ball";
    volume.density =
        formats::fill_grid(glm::ivec3(-kRadius), glm::ivec3(kRadius), 1.0, [](glm::ivec3 at) {
            const int square = at.x * at.x + at.y * at.y + at.z * at.z;
            return square <= kRadius * kRadius ? 1.0 : 0.0;
        });
    volume.sigma_t = {0.25f, 0.25f, 0.25f};
    volume.albedo = {0.99f, 0.99f, 0.99f};
    formats::Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(std::move(volume));
    return scene;
}

void calibrate_volumes(const CalibrationBench& bench, Rates& rates) {
    if (!bench.is_many) {
        return;
    }
    const formats::Scene scene = make_calibration_volume();
    const auto sky = RayScene::build({}, 1);
    Knobs knobs;
    knobs.cubemap_size = 8;
    // One thing more at a time: rows, walks, and directions whose light joins them.
    const VolumeLayout once{.once_terms = 1, .spacing = 8};
    const VolumeLayout often{.once_terms = 1, .often_terms = 1, .spacing = 8, .walks = 1};
    const VolumeLayout rows{.once_terms = 25, .often_terms = 25, .spacing = 8, .walks = 1};
    const VolumeLayout walks{.once_terms = 1, .often_terms = 1, .spacing = 8, .walks = 8};
    // Walks go to finer cells in a bake of reference quality, if its rows have as many.
    Knobs coarse = knobs, fine = knobs;
    coarse.cubemap_size = fine.cubemap_size = 16;
    fine.quality = Quality::reference;
    const double alone = measure_bake(scene, *sky, once, knobs);
    const double few_rows = measure_bake(scene, *sky, often, knobs);
    const double many_rows = measure_bake(scene, *sky, rows, knobs);
    const double walked = measure_bake(scene, *sky, walks, coarse);
    const double finely = measure_bake(scene, *sky, walks, fine);
    const VolumeWork lit = count_volume_work(scene, {&once, 1}, knobs).front();
    const VolumeWork few = count_volume_work(scene, {&walks, 1}, coarse).front();
    const VolumeWork many = count_volume_work(scene, {&walks, 1}, fine).front();
    const auto texels = static_cast<double>(formats::cubemap_texels(knobs.cubemap_size));
    rates.node_texel = std::max(0.0, many_rows - few_rows) /
                       (lit.nodes * (rows.often_terms - often.often_terms) * texels);
    rates.density_step =
        std::max(0.0, alone - lit.nodes * texels * rates.node_texel) / lit.depth_steps;
    rates.scattered_cell =
        std::max(0.0, finely - walked) / (few.collisions * (many.walk_cells - few.walk_cells));
    rates.volume_flight = measure_flight(scene);
}

}  // namespace opaline::bake
