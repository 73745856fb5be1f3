#include "runtime/web/page_layer.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/part_environments.h"
#include "runtime/clouds/plane_gather.h"
#include "runtime/clouds/radiosity.h"
#include "runtime/clouds/shader_layer.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/volume_bounds.h"
#include "runtime/web/data_script.h"

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
        script.put("plan steps", steps_);
        script.put("plan values", values_);
    }

  private:
    void add_place() { add_step(static_cast<std::uint32_t>(values_.size())); }

    std::vector<std::uint32_t> steps_;
    std::vector<float> values_;
};

// What a page needs to solve the light between the ground and the base of a layer by itself, for
// any light and time: how planes gather from each other (plane_gather.h), which depends on the
// grid of cells alone, and how many passes are enough whatever part of the layer is above a cell.
// `plan steps`: columns, rows, whether they wrap, passes; then by level its columns, rows, number
// of Gaussians and where in `plan values` the mixes begin: of reductions along x and z, of
// spreading along x and z; then of each Gaussian along x, along z: first cell, count, place of the
// weights. A mix takes eight values: first cell, count, six weights. `plan step`: a quarter of a
// cell along x and z [m], where cells are sampled.
// `light`: of any light and time.
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
    script.put("plan step", step);
}

formats::Vec3 centre_of(const formats::AssetView& asset) {
    const BoundingSphere bound = bound_asset(asset);
    return {static_cast<float>(bound.x), static_cast<float>(bound.y), static_cast<float>(bound.z)};
}

// Levels after each other, and their sizes.
void put_pictures(DataScript& script, const std::string& name,
                  std::span<const MipLevel<Rgb>> levels) {
    std::vector<float> pixels;
    std::vector<std::uint32_t> sizes;
    for (const MipLevel<Rgb>& level : levels) {
        sizes.insert(sizes.end(), {level.columns, level.rows});
        for (const Rgb pixel : level.value) {
            pixels.insert(pixels.end(), {pixel.r, pixel.g, pixel.b});
        }
    }
    script.put(name, pixels);
    script.put(name + " sizes", sizes);
}

// Puts all into one array; each begins at a number of its own.
void put_joined(DataScript& script, const std::string& name,
                const std::vector<std::vector<float>>& parts) {
    std::vector<float> all;
    std::vector<std::uint32_t> first;
    for (const std::vector<float>& part : parts) {
        first.push_back(static_cast<std::uint32_t>(all.size()));
        all.insert(all.end(), part.begin(), part.end());
    }
    script.put(name, all);
    script.put(name + " first", first);
}

void append_grid(const LayerGrid& grid, std::vector<float>& values) {
    for (const double value : {grid.low_x, grid.low_z, grid.size_x, grid.size_z}) {
        values.push_back(static_cast<float>(value));
    }
}

// A time at which the layer is uneven, if there is one [s].
double uneven_time(const formats::LayerRecord& record, std::span<const std::uint16_t> codes) {
    for (std::uint32_t frame = 0; frame < record.frames; ++frame) {
        const auto of_frame = codes.subspan(frame * record.frame_count(), record.frame_count());
        const auto is_other = [&](std::uint16_t code) { return code != of_frame.front(); };
        if (std::ranges::any_of(of_frame, is_other)) {
            return static_cast<double>(record.frame_seconds) * frame;
        }
    }
    return 0;
}

// Where bodies are lit, at any time: beneath a layer that is even for a while all points see the
// same.
void put_light_points(DataScript& script, const formats::AssetView& asset) {
    const formats::LayerRecord& record = asset.clouds.records.front();
    const auto codes = asset.clouds.thickness_of(record);
    const LayerField field = make_layer_field(record, codes, uneven_time(record, codes));
    const formats::Vec3 centre = centre_of(asset);
    const LightPoints points = light_points(asset, volume_corners(asset.volumes), field, centre);
    std::vector<float> places{centre.x, centre.y, centre.z};
    for (const formats::Vec3 point : points.point) {
        places.insert(places.end(), {point.x, point.y, point.z});
    }
    script.put("light points", places);
    script.put("light point of primitives", points.of_primitive);
    script.put("light point of volumes", std::array{points.of_volumes});
}

}  // namespace

void put_layer(DataScript& script, const formats::AssetView& asset) {
    const LayerLight light = light_layers(asset.clouds, {}, {}, {.time = 0, .threads = 1});
    const LayerKind kind = layer_kind(light);
    const formats::LayerRecord& record = light.record;
    script.put("layer kind", std::array{kind.repeats ? 1u : 0u, kind.modes, kind.glows ? 1u : 0u});
    script.put("layer frames",
               std::array{record.columns, record.rows, record.frames, record.loops() ? 1u : 0u});
    script.put("layer motion",
               std::array{record.highest, record.frame_seconds, record.wind[0], record.wind[1]});
    script.put("layer codes", asset.clouds.thickness_of(record));
    std::vector<float> means;
    for (const formats::LayerTables& tables : light.tables) {
        means.insert(means.end(), tables.mean_t.begin(), tables.mean_t.end());
    }
    put_joined(script, "layer tables",
               {pack_layer_phase(light), pack_layer_flux(light), pack_layer_glow(light), means});
    put_pictures(script, "layer albedo", light.albedo.level);
    put_radiosity(script, light);
    put_light_points(script, asset);
}

void put_layer_light(DataScript& script, const LayerLight& light) {
    const ShaderLayer record = make_shader_layer(light);
    script.put_records("layer record", std::span<const ShaderLayer>(&record, 1));
    put_joined(script, "layer suns", {pack_sun_tables(light), pack_sun_flux(light)});
    const LayerPlaces places = layer_places(light);
    std::vector<float> values;
    for (const LayerGrid* grid : {&places.field, &places.ground, &places.light}) {
        append_grid(*grid, values);
    }
    values.push_back(static_cast<float>(places.base));
    values.push_back(static_cast<float>(places.ground_height));
    script.put("layer places", values);
}

}  // namespace opaline::runtime
