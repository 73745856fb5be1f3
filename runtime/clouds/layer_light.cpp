#include "runtime/clouds/layer_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/clouds/radiosity.h"
#include "runtime/clouds/see_layer.h"
#include "runtime/parallel.h"
#include "runtime/texture.h"

namespace opaline::runtime {
namespace {

using formats::LayerRecord;
using formats::Rgb;

MipPyramid<Rgb> decode_ground(const formats::CloudsView& clouds, const LayerRecord& record) {
    std::vector<Rgb> albedo;
    albedo.reserve(record.ground_count());
    for (const auto& code : clouds.ground_of(record)) {
        albedo.push_back(
            {linear_from_srgb(code[0]), linear_from_srgb(code[1]), linear_from_srgb(code[2])});
    }
    return make_pyramid(record.ground_columns, record.ground_rows, std::move(albedo),
                        record.repeats() ? MipBorder::repeat : MipBorder::clamp);
}

LitSun light_sun(const LayerSun& sun, const LayerLight& light) {
    LitSun lit;
    lit.direction = sun.direction;
    lit.irradiance = sun.irradiance;
    lit.cosine = std::clamp(sun.direction.y, kLeastCosine, 1.0f);
    const float height = light.record.base - light.record.ground;
    lit.shadow_x = height / lit.cosine * sun.direction.x;
    lit.shadow_z = height / lit.cosine * sun.direction.z;
    // The penumbra of the sun's disc, and how far a slanted path goes through the layer.
    const float tangent = std::hypot(sun.direction.x, sun.direction.z) / lit.cosine;
    lit.shadow_blur =
        std::max(2 * sun.angular_radius * height / lit.cosine, light.record.highest * tangent / 4);
    lit.table = make_sun_table(light.tables, light.record, lit.cosine);
    return lit;
}

LightGrid grid_of(const GroundCells& cells, std::vector<Rgb> values) {
    return {{cells.grid.columns, cells.grid.rows, std::move(values)},
            cells.grid.wraps ? MipBorder::repeat : MipBorder::clamp,
            cells.low_x,
            cells.low_z,
            static_cast<double>(cells.grid.cell_x) * cells.grid.columns,
            static_cast<double>(cells.grid.cell_z) * cells.grid.rows};
}

// What one point of the ground and the point of the base above it are.
RadiosityCell cell_at(const LayerLight& light, double x, double z, double footprint) {
    RadiosityCell cell;
    const float thickness = sample_thickness(light.field, x, z, light.field.level_of(footprint));
    const std::array<float, 3> depth = rest_depths(light, thickness);
    std::array<float, 3> mean{};
    for (std::size_t b = 0; b < 3; ++b) {
        mean[b] = mean_transmittance(light.tables[b], depth[b]);
    }
    cell.emission = Rgb{mean[0], mean[1], mean[2]} * light.sky.irradiance;
    cell.reflectance = {1 - mean[0], 1 - mean[1], 1 - mean[2]};
    for (const LitSun& sun : light.sun) {
        std::array<float, 3> diffuse{};
        for (std::size_t b = 0; b < 3; ++b) {
            const FluxShares flux =
                flux_shares(light.tables[b], light.record, depth[b], sun.cosine);
            diffuse[b] = flux.across - flux.once;
        }
        const Rgb flux = sun.direction.y * sun.irradiance;
        cell.emission = cell.emission + flux * Rgb{diffuse[0], diffuse[1], diffuse[2]};
        cell.direct = cell.direct + flux * direct_share(light, sun, x, z, footprint);
    }
    if (light.record.has_radiosity()) cell.albedo = ground_albedo(light, x, z, footprint);
    return cell;
}

RadiosityCell mean_cell(const LayerLight& light, const GroundCells& cells, std::uint32_t column,
                        std::uint32_t row) {
    const double side_x = static_cast<double>(cells.grid.cell_x) / kGroundSamples;
    const double side_z = static_cast<double>(cells.grid.cell_z) / kGroundSamples;
    constexpr float kShare = 1.0f / (kGroundSamples * kGroundSamples);
    RadiosityCell mean;
    for (std::uint32_t j = 0; j < kGroundSamples; ++j) {
        for (std::uint32_t i = 0; i < kGroundSamples; ++i) {
            const RadiosityCell at = cell_at(
                light, cells.low_x + (column * kGroundSamples + i + 0.5) * side_x,
                cells.low_z + (row * kGroundSamples + j + 0.5) * side_z, std::max(side_x, side_z));
            mean.emission = mean.emission + kShare * at.emission;
            mean.direct = mean.direct + kShare * at.direct;
            mean.albedo = mean.albedo + kShare * at.albedo;
            mean.reflectance = mean.reflectance + kShare * at.reflectance;
        }
    }
    return mean;
}

// No layer above the mean of the ground.
RadiosityCell open_cell(const LayerLight& light) {
    RadiosityCell cell;
    cell.emission = light.sky.irradiance;
    for (const LitSun& sun : light.sun) {
        cell.direct = cell.direct + sun.direction.y * sun.irradiance;
    }
    if (light.record.has_radiosity()) cell.albedo = light.albedo.level.back().value.front();
    return cell;
}

// Cells along an axis of `length`.
std::uint32_t cells_along(double length, double height) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(2 * length / height), 1.0, static_cast<double>(kMostGroundCells)));
}

}  // namespace

LayerLight light_layers(const formats::CloudsView& clouds, const formats::Environment& environment,
                        const Rotation& rotation, const LayerLightOptions& options) {
    LayerLight light;
    light.record = clouds.records.front();
    for (std::size_t b = 0; b < 3; ++b) {
        light.tables[b] = tables_of(clouds, light.record, b);
        light.rest_kappa[b] = light.record.band[b].rest_kappa();
        light.peak_mean_square[b] = peak_mean_square(light.tables[b], light.record);
    }
    light.field = make_layer_field(light.record, clouds.thickness_of(light.record), options.time);
    light.albedo = decode_ground(clouds, light.record);
    light.sky = split_sky(environment, rotation);
    for (const LayerSun& sun : light.sky.suns) {
        light.sun.push_back(light_sun(sun, light));
    }
    const GroundCells cells = cut_ground(light, options.threads);
    RadiosityOptions solving;
    solving.threads = options.threads;
    Radiosity solution = solve_radiosity(cells.grid, cells.cell, cells.outside, solving);
    light.ground_light = grid_of(cells, std::move(solution.ground));
    light.base_light = grid_of(cells, std::move(solution.base));
    return light;
}

std::array<float, 3> rest_depths(const LayerLight& light, float thickness) {
    return {light.rest_kappa[0] * thickness, light.rest_kappa[1] * thickness,
            light.rest_kappa[2] * thickness};
}

Rgb direct_share(const LayerLight& light, const LitSun& sun, double x, double z, double footprint) {
    const double blur = std::max(static_cast<double>(sun.shadow_blur), footprint);
    const float thickness =
        sample_thickness(light.field, x + static_cast<double>(sun.shadow_x),
                         z + static_cast<double>(sun.shadow_z), light.field.level_of(blur));
    const std::array<float, 3> depth = rest_depths(light, thickness);
    std::array<float, 3> share{};
    for (std::size_t b = 0; b < 3; ++b) {
        const FluxShares flux = flux_shares(light.tables[b], light.record, depth[b], sun.cosine);
        share[b] = flux.straight + flux.once;
    }
    return {share[0], share[1], share[2]};
}

GroundCells cut_ground(const LayerLight& light, unsigned threads) {
    const formats::LayerRecord& record = light.record;
    const double height = static_cast<double>(record.base - record.ground);
    // Beyond twice the height a plane has 20 % of its light.
    const double margin = record.repeats() ? 0 : 2 * height;
    const double size_x = light.field.size_x + 2 * margin;
    const double size_z = light.field.size_z + 2 * margin;
    GroundCells cells;
    cells.low_x = light.field.low_x - margin;
    cells.low_z = light.field.low_z - margin;
    cells.grid.columns = cells_along(size_x, height);
    cells.grid.rows = cells_along(size_z, height);
    cells.grid.cell_x = static_cast<float>(size_x / cells.grid.columns);
    cells.grid.cell_z = static_cast<float>(size_z / cells.grid.rows);
    cells.grid.distance = record.base - record.ground;
    cells.grid.wraps = record.repeats();
    cells.outside = open_cell(light);
    cells.cell.resize(std::size_t{cells.grid.columns} * cells.grid.rows);
    for_ranges(cells.grid.rows, 4, threads, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t row = first; row < end; ++row) {
            for (std::uint32_t column = 0; column < cells.grid.columns; ++column) {
                cells.cell[std::size_t{row} * cells.grid.columns + column] =
                    mean_cell(light, cells, column, row);
            }
        }
    });
    return cells;
}

}  // namespace opaline::runtime
