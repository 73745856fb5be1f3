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

    bool is_shown() const { return block_ != 0; }
    const LayerKind& kind() const { return kind_; }
    const LayerPlaces& places() const { return places_; }  ///< in the light shown

    GLuint block() const { return block_; }
    GLuint table_values() const { return table_values_.name(); }
    GLuint sun_values() const { return sun_values_.name(); }
    GLuint thickness_values() const { return thickness_values_.name(); }
    GLuint albedo_map() const { return albedo_map_; }
    GLuint ground_light() const { return ground_light_; }
    GLuint base_light() const { return base_light_; }

  private:
    opaline_status check_sizes(const LayerLight& light) const;
    void make(const LayerLight& light, GlNames& names);
    void fill_picture(GLuint texture, std::size_t level, const MipLevel<formats::Rgb>& picture);

    const GlFunctions& gl_;
    LayerKind kind_;
    LayerPlaces places_;
    FrameBlend frames_;                          // that the thickness is of
    std::array<std::int32_t, 4> value_first_{};  // as in layer_tables.glsl
    TexelLines table_values_{gl_, kFloatTexel}, sun_values_{gl_, kFloatTexel};
    TexelLines thickness_values_{gl_, kFloatTexel};
    GLuint block_ = 0, albedo_map_ = 0, ground_light_ = 0, base_light_ = 0;
};

}  // namespace opaline::runtime
