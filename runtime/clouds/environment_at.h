#pragma once

#include <cstdint>

#include "formats/opal/environment.h"
#include "formats/opal/vec3.h"
#include "runtime/clouds/see_layer.h"

namespace opaline::runtime {

struct EnvironmentAtOptions {
    std::uint32_t width = 256, height = 128;  ///< of the map in pixels, > 0; an even height has
                                              ///< the horizon between two rows
    unsigned threads = 0;  ///< 0: all cores; the result has the same bits for any number
};

/// Layer, ground and sky as seen from a point: the distant light with which a host relights a small
/// body there, in world directions (no rotation is left to apply). The map is see_through_layer
/// without the suns, averaged over each pixel; around suns it has their glow. The discs are the
/// suns and the environment's other discs above the horizon, attenuated by the layer, and a map's
/// sun as a disc of its radius. A point below the ground is lifted onto it. The body itself shades
/// neither ground nor layer. The irradiance on any plane differs by less than 1 % from that of rays
/// without end at the default size. Precondition: the point is finite.
formats::Environment environment_at(const LayerScene& scene, formats::Vec3 point,
                                    const EnvironmentAtOptions& options = {});

}  // namespace opaline::runtime
