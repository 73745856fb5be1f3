#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "formats/opal/clouds.h"
#include "formats/opal/result.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/shader_layer.h"
#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {

/// A cloud layer on the GPU. What is of the layer alone is uploaded once, its thickness where other
/// frames are seen of it, what is of a light or a time each time: some 10 to 500 kB.
struct GlLayers {
    bool shown = false;  ///< false: there is none, or no light yet

    // Of the layer.
    GlBuffer thickness;  ///< all levels of LayerField::thickness [m]
    FrameBlend frames;   ///< that it is of
    GlTexture albedo;    ///< all levels of LayerLight::albedo
    GlBuffer phase, flux, glow;

    // Of a light and a time.
    GlTexture ground_light, base_light;
    GlBuffer sun_tables, sun_flux;
    GlBuffer block;       ///< Layer of layer_tables.glsl
    std::string defines;  ///< what the shader is compiled for
    std::vector<LayerSun> suns;
    LayerPlaces places;

    std::size_t layer_bytes = 0, light_bytes = 0;  ///< in textures and buffers
};

/// Uploads what `light` holds; of the layer only the first time, or frames that it did not show.
/// Errors: resource (memory; pictures larger than the driver takes). Precondition: it is of the
/// same layer each time.
formats::Status relight_gl_layers(GlLayers& layers, const LayerLight& light);

}  // namespace opaline::runtime
