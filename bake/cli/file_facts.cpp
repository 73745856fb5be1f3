#include "bake/cli/file_facts.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "bake/cli/messages.h"
#include "bake/lights/builtin_environment.h"
#include "runtime/light_vector.h"
#include "runtime/shade.h"

namespace opaline::cli {
namespace {

// [m]
float largest_thickness(const formats::CloudsView& clouds, const formats::LayerRecord& layer) {
    const auto codes = clouds.thickness_of(layer);
    return layer.highest * static_cast<float>(*std::max_element(codes.begin(), codes.end())) /
           65535;
}

// Of all that belongs to it, decoded.
std::uint64_t bytes_of_layer(const formats::LayerRecord& layer) {
    return sizeof layer + layer.thickness_count() * sizeof(std::uint16_t) +
           layer.ground_count() * 4 + layer.value_count() * sizeof(float);
}

template <class Get>
nlohmann::ordered_json each_band(const formats::LayerRecord& layer, Get get) {
    auto values = nlohmann::ordered_json::array();
    for (const formats::LayerBand& band : layer.band)
        values.push_back(get(band));
    return values;
}

bool scatters_often(const formats::LayerRecord& layer) {
    return layer.radiance_count() > 0;
}

// Over the area of the surfaces, however many receivers are where.
double sum_luminance(const formats::AssetView& view, const runtime::LightVector& sky,
                     std::span<const formats::Rgb> emitters) {
    std::vector<formats::Rgb> radiance(view.receivers());
    runtime::ShadeOptions options;
    options.emitters = {emitters, false};
    runtime::shade(view, sky, radiance, options);
    double sum = 0;
    for (const formats::PrimitiveRecord& p : view.primitives) {
        for (std::uint32_t i = 0; i + 2 < p.index_count; i += 3) {
            const std::uint32_t* const corner = &view.index[p.first_index + i];
            const auto at = [&](int k) { return view.position[p.first_vertex + corner[k]]; };
            const double area =
                0.5 * static_cast<double>(length(cross(at(1) - at(0), at(2) - at(0))));
            for (int k = 0; k < 3; ++k) {
                const formats::Rgb shown = radiance[p.first_vertex + corner[k]];
                sum += area / 3 * static_cast<double>(formats::luminance(shown));
            }
        }
    }
    return sum;
}

// Offsets, scales, averages, indices and codes of a volume's rows.
std::uint64_t row_bytes(const formats::SparseRowsView& rows, const formats::RowRange& range) {
    const std::uint64_t details =
        rows.row_offset[range.first_row + range.rows] - rows.row_offset[range.first_row];
    const std::uint64_t band_rows = std::uint64_t{range.rows} * range.bands;
    return range.rows * sizeof(std::uint32_t) +
           band_rows * (2 * sizeof(float) + 6 * sizeof(std::int16_t)) +
           details * (rows.index_bytes + range.bands * std::uint64_t{rows.code_bits} / 8);
}

}  // namespace

nlohmann::ordered_json layers_json(const formats::CloudsView& clouds) {
    auto layers = nlohmann::ordered_json::array();
    for (const formats::LayerRecord& layer : clouds.records) {
        layers.push_back(
            {{"base", layer.base},
             {"ground", layer.ground},
             {"center", layer.center},
             {"size", layer.size},
             {"wind", layer.wind},
             {"repeats", layer.repeats()},
             {"largest_thickness", largest_thickness(clouds, layer)},
             {"thickness_cells", {layer.columns, layer.rows}},
             {"frames", layer.frames},
             {"frame_seconds", layer.frame_seconds},
             {"loops", layer.loops()},
             {"ground_cells", {layer.ground_columns, layer.ground_rows}},
             {"haze", layer.haze},
             {"kappa", each_band(layer, [](const auto& band) { return band.kappa; })},
             {"fidelity", layer.is_paper() ? "paper" : "physical"},
             {"peak_angle", layer.peak_angle},
             {"peak_weight", each_band(layer, [](const auto& band) { return band.peak_weight; })},
             {"g", each_band(layer, [](const auto& band) { return band.g; })},
             {"multiple_scattering", scatters_often(layer)},
             {"radiosity", layer.has_radiosity()},
             {"tables",
              {{"phase", layer.phase_angles},
               {"glow", {layer.glow_angles, layer.glow_events}},
               {"flux", {layer.flux_depths, layer.flux_cosines}},
               {"radiance",
                {layer.radiance_depths, layer.radiance_cosines, layer.radiance_modes}}}},
             {"bytes", bytes_of_layer(layer)}});
    }
    return layers;
}

void print_layers(const formats::CloudsView& clouds) {
    if (!clouds.empty()) {
        fmt::print("cloud layers\n");
    }
    for (std::size_t i = 0; i < clouds.records.size(); ++i) {
        const formats::LayerRecord& layer = clouds.records[i];
        if (!(layer.highest > 0)) {
            fmt::print(
                "  {:>3}  no cloud: the ground at {:g} m alone, {} x {} cells of {:g} x {:g} m; "
                "{}\n",
                i, layer.ground, layer.ground_columns, layer.ground_rows, layer.size[0],
                layer.size[1], format_bytes(static_cast<double>(bytes_of_layer(layer))));
            continue;
        }
        const auto& [r, g, b] = layer.band;
        fmt::print(
            "  {:>3}  base at {:g} m over ground at {:g} m, {:g} x {:g} m{}, up to {:.4g} m "
            "thick\n",
            i, layer.base, layer.ground, layer.size[0], layer.size[1],
            layer.repeats() ? " repeated" : "", largest_thickness(clouds, layer));
        fmt::print(
            "       extinction {:.4g}, {:.4g}, {:.4g} 1/m, {:.1f} % of it within {:.2g} rad{}\n",
            r.kappa, g.kappa, b.kappa, 100 * g.peak_weight, layer.peak_angle,
            layer.is_paper() ? "; fidelity paper" : "");
        if (layer.frames > 1) {
            fmt::print("       {} frames, one every {:g} s{}\n", layer.frames, layer.frame_seconds,
                       layer.loops() ? ", over and over" : "");
        }
        fmt::print(
            "       orders: {}; {} x {} cells, ground {} x {}{}\n"
            "       tables: phase {}, glow {} x {}, flux {} x {}, radiance {} x {} x {}; {}\n",
            scatters_often(layer) ? "0, 1, and 2 or more" : "0 and 1", layer.columns, layer.rows,
            layer.ground_columns, layer.ground_rows,
            layer.has_radiosity() ? ", light between ground and base" : "", layer.phase_angles,
            layer.glow_angles, layer.glow_events, layer.flux_depths, layer.flux_cosines,
            layer.radiance_depths, layer.radiance_cosines, layer.radiance_modes,
            format_bytes(static_cast<double>(bytes_of_layer(layer))));
    }
}

std::vector<double> compare_with_sky(const formats::AssetView& view) {
    std::vector<double> times;
    if (view.emitters.empty()) return times;
    std::vector<formats::Rgb> colors(view.emitters.size());
    const auto light_of = [&](const formats::Environment& sky) {
        return runtime::project_environment(sky, view.cubemap_size, {});
    };
    const double white = sum_luminance(view, light_of(*bake::make_environment("white")), colors);
    const runtime::LightVector black = light_of({});
    for (formats::Rgb& color : colors) {
        color = {1, 1, 1};
        times.push_back(white > 0 ? sum_luminance(view, black, colors) / white : std::nan(""));
        color = {};
    }
    return times;
}

VolumeFacts volume_facts(const formats::VolumesView& volumes, const formats::VolumeRecord& record) {
    const std::uint64_t bricks = record.brick_count;
    const auto density = volumes.density.subspan(record.first_brick_number * formats::kBrickVoxels,
                                                 bricks * formats::kBrickVoxels);
    VolumeFacts facts;
    facts.active_voxels =
        density.size() - static_cast<std::uint64_t>(std::ranges::count(density, 0));
    const std::uint64_t cells =
        std::uint64_t{record.extent[0]} * record.extent[1] * record.extent[2];
    facts.bytes =
        sizeof(record) + formats::kPhaseEntries * sizeof(float) + cells * sizeof(std::uint32_t) +
        bricks * (sizeof(float) + formats::kBrickVoxels * sizeof(std::uint16_t) +
                  record.corners_of_brick() * sizeof(std::uint32_t)) +
        record.node_count * sizeof(formats::NodeVoxel) + row_bytes(volumes.rows, record.rows());
    return facts;
}

}  // namespace opaline::cli
