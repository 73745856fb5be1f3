#include "runtime/web/page_radiosity.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/clouds/ground_cells.h"
#include "runtime/clouds/plane_gather.h"
#include "runtime/clouds/radiosity.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

PlaneGrid grid_of(const LayerLight& light) {
    const LightGrid& cells = light.ground_light;
    PlaneGrid grid;
    grid.columns = cells.cell.columns;
    grid.rows = cells.cell.rows;
    grid.cell_x = static_cast<float>(cells.size_x / grid.columns);
    grid.cell_z = static_cast<float>(cells.size_z / grid.rows);
    grid.distance = light.record.base - light.record.ground;
    grid.wraps = light.record.repeats();
    return grid;
}

// Beneath the thickest part of the layer, above the brightest ground.
std::uint32_t most_passes(const LayerLight& light) {
    if (!light.record.has_radiosity()) return 0;
    Rgb albedo;
    for (const Rgb& texel : light.albedo.level.front().value) {
        albedo = {std::max(albedo.r, texel.r), std::max(albedo.g, texel.g),
                  std::max(albedo.b, texel.b)};
    }
    const std::array<float, 3> depth = rest_depths(light, light.record.highest);
    std::array<float, 3> reflectance{};
    for (std::size_t b = 0; b < 3; ++b) {
        reflectance[b] = 1 - mean_transmittance(light.tables[b], depth[b]);
    }
    return count_passes(albedo, {reflectance[0], reflectance[1], reflectance[2]}, {});
}

class PlanWriter {
  public:
    void add_step(std::uint32_t word) { steps_.push_back(word); }
    void add_taps(const GatherPlan::Taps& taps) {
        add_step(static_cast<std::uint32_t>(taps.first));
        add_step(static_cast<std::uint32_t>(taps.weight.size()));
        add_place();
        values_.insert(values_.end(), taps.weight.begin(), taps.weight.end());
    }
    void add_mixes(const std::vector<GatherPlan::Mix>& mixes) {
        add_place();
        for (const GatherPlan::Mix& mix : mixes) {
            values_.push_back(static_cast<float>(mix.first));
            values_.push_back(static_cast<float>(mix.count));
            values_.insert(values_.end(), mix.weight.begin(), mix.weight.end());
        }
    }
    void put(DataScript& script) const {
        script.put("plan steps", std::span<const std::uint32_t>(steps_));
        script.put("plan values", std::span<const float>(values_));
    }

  private:
    void add_place() { add_step(static_cast<std::uint32_t>(values_.size())); }

    std::vector<std::uint32_t> steps_;
    std::vector<float> values_;
};

}  // namespace

void put_radiosity(DataScript& script, const LayerLight& light) {
    const PlaneGrid grid = grid_of(light);
    PlanWriter writer;
    for (const std::uint32_t word :
         {grid.columns, grid.rows, grid.wraps ? 1u : 0u, most_passes(light)}) {
        writer.add_step(word);
    }
    for (const GatherPlan::Level& level : make_gather_plan(grid).level) {
        writer.add_step(level.columns);
        writer.add_step(level.rows);
        writer.add_step(static_cast<std::uint32_t>(level.gaussian.size()));
        for (const auto& mixes : {level.reduce_x, level.reduce_z, level.spread_x, level.spread_z}) {
            writer.add_mixes(mixes);
        }
        for (const GatherPlan::Gaussian& gaussian : level.gaussian) {
            writer.add_taps(gaussian.x);
            writer.add_taps(gaussian.z);
        }
    }
    writer.put(script);
    const std::array<float, 2> step{grid.cell_x / kGroundSamples, grid.cell_z / kGroundSamples};
    script.put("plan step", std::span<const float>(step));
}

}  // namespace opaline::runtime
