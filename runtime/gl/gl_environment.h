#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"
#include "runtime/specular.h"

namespace opaline::runtime {

/// An environment on the GPU, for the background: the map in full float precision and the discs.
struct GlEnvironment {
    enum class Map : std::int32_t { none = 0, lat_long = 1, cube = 2 } map = Map::none;
    GlTexture texture;  ///< array of one layer (lat-long) or six (cube)
    GlBuffer discs;     ///< direction, chord of the radius; radiance, 0
    std::int32_t disc_count = 0;
    float u_offset = 0.5f, u_sign = 1.0f;
    bool rows_include_poles = false;
    std::size_t resident = 0;  ///< [bytes]
};

/// Errors: resource (memory, a map larger than the driver takes), usage (pixel count and size
/// disagree).
formats::Result<GlEnvironment> upload_environment(const formats::Environment& environment);

/// Specular light on the GPU: for each map of a SpecularLight an array of six layers.
struct GlSpecular {
    SpecularLight light;  ///< for its levels; its pixels are on the GPU
    std::vector<GlTexture> texture;
    // For glossy opaque surfaces, where there are some (GlossLight, ggx_albedo_table):
    GlTexture light_maps;  ///< an array of six layers, half as wide at each level
    GlBuffer cells;        ///< direction, solid angle; flux, widening
    GlBuffer suns;         ///< direction, radius; radiance, solid angle
    std::int32_t suns_count = 0;
    GlBuffer albedo;
    std::size_t resident = 0;  ///< [bytes]
};

/// Errors: resource.
formats::Result<GlSpecular> upload_specular(SpecularLight light);

}  // namespace opaline::runtime
