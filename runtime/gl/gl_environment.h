#pragma once

#include <cstdint>

#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// An environment on the GPU, for the background: the map in full float precision and the discs.
struct GlEnvironment {
    enum class Map : std::int32_t { none = 0, lat_long = 1, cube = 2 } map = Map::none;
    GLuint texture = 0;  ///< array of one layer (lat-long) or six (cube)
    GLuint discs = 0;    ///< a row each: direction, chord of the radius; radiance, 0
    std::int32_t disc_count = 0;
    float u_offset = 0.5f, u_sign = 1.0f;
    bool rows_include_poles = false;
};

/// Errors: resource (memory, a map larger than the driver takes), usage (pixel count and size
/// disagree).
formats::Result<GlEnvironment> upload_environment(const formats::Environment& environment,
                                                  const GlFunctions& functions, GlNames& names);

}  // namespace opaline::runtime
