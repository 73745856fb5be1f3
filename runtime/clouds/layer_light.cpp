#include "runtime/clouds/layer_light.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "runtime/clouds/ground_cells.h"
#include "runtime/clouds/radiosity.h"
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

}  // namespace opaline::runtime
