#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "formats/opal/clouds.h"
#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_field.h"
#include "runtime/clouds/layer_tables.h"
#include "runtime/clouds/mip_pyramid.h"
#include "runtime/clouds/radiosity.h"
#include "runtime/clouds/sky_light.h"
#include "runtime/light_vector.h"

namespace opaline::runtime {

/// A sun and the values that depend on its height alone.
struct LitSun {
    formats::Vec3 direction;           ///< unit, toward the sun, world
    formats::Rgb irradiance;           ///< E, on a plane facing it [W/m^2]
    float cosine = 1;                  ///< mu_l, to +Y, at least kLeastCosine
    float shadow_x = 0, shadow_z = 0;  ///< from the ground to where its light crosses the base [m]
    float shadow_blur = 0;             ///< length over which shadows on the ground are even [m]
    SunTable table;
};
inline constexpr float kLeastCosine = 1e-3f;  ///< of light and view to a normal

/// A grid of light over x and z, the first corner at (low_x, low_z) [m].
struct LightGrid {
    MipLevel<formats::Rgb> cell;  ///< irradiance [W/m^2]
    MipBorder border = MipBorder::clamp;
    double low_x = 0, low_z = 0, size_x = 1, size_z = 1;

    formats::Rgb at(double x, double z) const {
        return sample_level(cell, border, (x - low_x) / size_x, (z - low_z) / size_z);
    }
};

/// A layer, the ground and the sky at one time, for any eye: all that depends on light and time.
/// `tables` and `view` refer to the asset's bytes.
struct LayerLight {
    formats::LayerRecord record;
    std::array<formats::LayerTables, 3> tables;  ///< by band
    std::array<float, 3> rest_kappa{};           ///< kappa_S [1/m], by band
    std::array<float, 3> peak_mean_square{};     ///< of angles [rad^2], by band (layer_tables.h)
    LayerField field;
    MipPyramid<formats::Rgb> albedo;  ///< of the ground over the record's size, which does not move
    SkyLight sky;
    std::vector<LitSun> sun;  ///< kMaxLayerSuns at most
    LightGrid ground_light;   ///< RG: irradiance on the ground but for T_0 + T_1 of the suns
    LightGrid base_light;     ///< RC: irradiance on the base from the ground
};

struct LayerLightOptions {
    double time = 0;       ///< [s]; finite
    unsigned threads = 0;  ///< 0: all cores; the result has the same bits for any number
};

/// The first layer of an asset. Preconditions: there is one, and it passed read_opal's checks; the
/// environment is finite and not negative.
LayerLight light_layers(const formats::CloudsView& clouds, const formats::Environment& environment,
                        const Rotation& rotation, const LayerLightOptions& options = {});

/// kappa_S H by band, for a thickness [m].
std::array<float, 3> rest_depths(const LayerLight& light, float thickness);

/// The share T_0 + T_1 of a sun's flux that reaches the ground at (x, z) with its direction roughly
/// kept; means over `footprint` [m] at least.
formats::Rgb direct_share(const LayerLight& light, const LitSun& sun, double x, double z,
                          double footprint);

/// The ground and the base of a layer as cells that light each other. Of a layer that repeats one
/// period; otherwise the layer and a margin around it, beyond which there is no layer.
struct GroundCells {
    PlaneGrid grid;
    double low_x = 0, low_z = 0;  ///< the first corner [m]
    std::vector<RadiosityCell> cell;
    RadiosityCell outside;
};

/// Cells half as long as the base is high, or as few as kMostGroundCells allow along an axis; each
/// is a mean over kGroundSamples^2 points. Where the layer has no radiosity the albedo counts as 0:
/// light from the base reaches the ground, and none goes back. Precondition: all of `light` but its
/// grids is set. The result has the same bits for any number of threads.
GroundCells cut_ground(const LayerLight& light, unsigned threads);
inline constexpr std::uint32_t kMostGroundCells = 128, kGroundSamples = 4;

}  // namespace opaline::runtime
