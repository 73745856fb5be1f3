#pragma once

#include <algorithm>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/effects.h"
#include "bake/effects/volumes/bake_volumes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/trace/ray_scene.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "tests/support/volumes.h"

namespace opaline::tests {

inline formats::Scene scene_of(formats::Volume volume) {
    formats::Scene scene;
    scene.materials.resize(1);
    scene.volumes.push_back(std::move(volume));
    return scene;
}

inline bake::RayScene empty_space() {
    return std::move(*bake::RayScene::build({}, 1));
}

inline bake::Knobs knobs_for(bake::Quality quality) {
    bake::BakeOptions options;
    options.quality = quality;
    return *bake::resolve_knobs(bake::all_effects(), options);
}

/// For bakes of small volumes: rows of 8 x 8 texels a face, nodes `spacing` voxels apart.
inline bake::Knobs small_knobs(bake::Quality quality, double spacing) {
    bake::Knobs knobs = knobs_for(quality);
    knobs.cubemap_size = 8;
    knobs.set(bake::kVolumeSpacing, spacing);
    return knobs;
}

/// What a bake makes of a scene's volumes; `surfaces`: those of the scene.
inline formats::Volumes bake_volumes_of(const formats::Scene& scene, const bake::RayScene& surfaces,
                                        const bake::Knobs& knobs, unsigned threads = 0) {
    const bake::VolumePlan plan = bake::plan_volumes(scene, knobs);
    bake::StageLog log;
    bake::Context context;
    context.threads = threads;
    auto volumes = bake::bake_volumes({scene, surfaces, plan.layouts, knobs}, context, log);
    if (!volumes) throw std::runtime_error("volumes cannot be baked");
    return std::move(*volumes);
}

/// The same of a scene without surfaces.
inline formats::Volumes bake_volumes_of(const formats::Scene& scene, const bake::Knobs& knobs,
                                        unsigned threads = 0) {
    return bake_volumes_of(scene, empty_space(), knobs, threads);
}

/// Even numbers in [0, 1) as walks draw them; counts them.
class UnitNumbers {
  public:
    explicit UnitNumbers(unsigned seed) : engine_(seed) {}
    float operator()() {
        ++drawn;
        return std::min(uniform_(engine_), 0x1.fffffep-1f);
    }
    int drawn = 0;

  private:
    std::mt19937 engine_;
    std::uniform_real_distribution<float> uniform_{0, 1};
};

/// Calls visit(voxel, brick, i) for voxels i < 512 of all bricks of a record, `voxel` on the grid.
template <class Visit>
void for_each_kept_voxel(const formats::Volumes& volumes, const formats::VolumeRecord& record,
                         Visit&& visit) {
    const glm::ivec3 first(record.first_brick[0], record.first_brick[1], record.first_brick[2]);
    for (std::uint32_t cell = 0; cell < volumes.table.size(); ++cell) {
        if (volumes.table[cell] == formats::kNoBrick) continue;
        const glm::ivec3 brick(cell % record.extent[0], cell / record.extent[0] % record.extent[1],
                               cell / record.extent[0] / record.extent[1]);
        for (int i = 0; i < 512; ++i) {
            visit(8 * (first + brick) + glm::ivec3(i % 8, i / 8 % 8, i / 64), volumes.table[cell],
                  static_cast<std::size_t>(i));
        }
    }
}

/// The integral of one band of a row over all directions.
inline double integrate_row(const formats::SparseRows& rows, const formats::VolumeRecord& record,
                            std::uint32_t row, std::uint32_t band = 0) {
    const std::uint32_t n = rows.cubemap_size;
    std::vector<float> dense(formats::cubemap_texels(n));
    formats::decode_row(rows.view(), record.rows(), row, band, dense);
    // Of even light L = 1 the vector is the transform of the texels' solid angles.
    const std::vector<double> face = formats::texel_solid_angles(n);
    std::vector<double> light;
    for (std::uint32_t f = 0; f < formats::kCubeFaces; ++f) {
        light.insert(light.end(), face.begin(), face.end());
    }
    formats::haar_forward_cube(std::span<double>(light), n);
    double sum = 0;
    for (std::size_t k = 0; k < dense.size(); ++k) {
        sum += light[k] * static_cast<double>(dense[k]);
    }
    return sum;
}

}  // namespace opaline::tests
