#pragma once

#include <array>
#include <cstdint>

#include "formats/opal/vec3.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/shader_layer.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/embed_gl/texel_lines.h"

namespace opaline::runtime {

/// A cloud layer as opaline_layer.glsl reads it: arrays in textures of 2048 columns, pictures in
/// textures, and a uniform block. Every call wants a SavedState around it.
class LayerTextures {
  public:
    explicit LayerTextures(const GlFunctions& gl) : gl_(gl) {}

    /// Uploads what `light` holds, under other names of GL never; of the layer only the first time,
    /// or frames that it did not show. OPALINE_GL_REFUSED: more texels than the driver takes.
    /// Precondition: it is of the same layer each time.
    opaline_status show(const LayerLight& light, formats::Vec3 eye, GlNames& names);
    /// [m, world]. Nothing before the first show.
    void look_from(formats::Vec3 eye);

    bool is_shown() const { return objects_.block != 0; }
    const LayerPlaces& places() const { return places_; }  ///< in the light shown
    /// Names, and what shaders are compiled for; all 0 before the first show.
    const opaline_gl_layer& objects() const { return objects_; }

  private:
    opaline_status check_sizes(const LayerLight& light) const;
    void make(const LayerLight& light, GlNames& names);
    void fill_picture(GLuint texture, std::size_t level, const MipLevel<formats::Rgb>& picture);

    const GlFunctions& gl_;
    LayerPlaces places_;
    FrameBlend frames_;                          // that the thickness is of
    std::array<std::int32_t, 4> value_first_{};  // as in layer_tables.glsl
    TexelLines table_values_{gl_, kFloatTexel}, sun_values_{gl_, kFloatTexel};
    TexelLines thickness_values_{gl_, kFloatTexel};
    opaline_gl_layer objects_{};
};

}  // namespace opaline::runtime
