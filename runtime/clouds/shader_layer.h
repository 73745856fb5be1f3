#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::runtime {

// A cloud layer as layer_tables.glsl and what follows it read it.

inline constexpr std::size_t kMaxLayerLevels = 16;  ///< of the thickness

/// LayerSun and Layer of layer_tables.glsl, in std140.
struct ShaderSun {
    std::array<float, 4> direction_cosine{}, irradiance_radius{}, shadow{};
};
struct ShaderLayer {
    using Vec4 = std::array<float, 4>;
    using Int4 = std::array<std::int32_t, 4>;
    Vec4 rest_kappa_peak{}, kappa_haze{}, peak_weight{}, peak_square{}, field{};
    Vec4 ground_cell_light{}, sky_irradiance{}, horizon_luminance{}, map_peak{};
    Int4 sun_discs{-1, -1, -1, -1}, field_albedo{}, levels_counts{}, counts{}, radiance_counts{};
    std::array<std::int32_t, kMaxLayerLevels> level_first{};
    std::array<ShaderSun, kMaxLayerSuns> suns;
};
static_assert(sizeof(ShaderLayer) == 14 * 16 + kMaxLayerLevels * 4 + kMaxLayerSuns * 48);

ShaderLayer make_shader_layer(const LayerLight& light);

/// Of the layer alone: all levels of the thickness one after the other, x fastest [m]; log P_S by
/// angle, then band; T_ms by band, depth and cosine; glow by band, event and angle. Values are
/// tamed: a damaged file may hold what not all drivers handle.
std::vector<float> pack_thickness(const LayerLight& light);
std::vector<float> pack_layer_phase(const LayerLight& light);
std::vector<float> pack_layer_flux(const LayerLight& light);
std::vector<float> pack_layer_glow(const LayerLight& light);
/// Of the suns: T_ms and T_1 by sun, depth and band; SunTable by sun, side, mode, depth, view,
/// band.
std::vector<float> pack_sun_flux(const LayerLight& light);
std::vector<float> pack_sun_tables(const LayerLight& light);

/// What shaders are compiled for, the same for every light of a layer.
struct LayerKind {
    bool repeats = false, glows = false;
    std::uint32_t modes = 0;
};
LayerKind layer_kind(const LayerLight& light);

/// Where a picture of the layer lies over x and z [m].
struct LayerGrid {
    double low_x = 0, low_z = 0, size_x = 1, size_z = 1;
    bool repeats = false;

    /// A point as shares of it, within one period where it repeats; in doubles up to there.
    std::array<float, 2> place_of(formats::Vec3 point) const;
};
struct LayerPlaces {
    LayerGrid field, ground, light;      ///< of thickness, albedo, and light
    double base = 0, ground_height = 0;  ///< [m]
};
LayerPlaces layer_places(const LayerLight& light);

}  // namespace opaline::runtime
