#pragma once

#include <cstddef>
#include <vector>

#include "runtime/embed_gl/gl_names.h"
#include "runtime/gloss_light.h"
#include "runtime/specular.h"

namespace opaline::runtime {

/// Distant light as opaline_gloss.glsl looks it up; GlossLight in textures. Every call wants a
/// SavedState around it.
class GlossyLight {
  public:
    explicit GlossyLight(const GlFunctions& gl) : gl_(gl) {}

    /// Black, with the table of albedos. Notes the names in `objects`:
    /// light_maps: a 2D array of six layers, half as wide at each level;
    /// cells, sun_table: two texels a cell, and a sun, as Cell and Sun of gloss.glsl, a row each;
    /// albedo: formats::ggx_albedo_table, in the first two bands.
    void make(GlNames& names, opaline_gl_objects& objects);

    /// Copies the light; one that was prepared for no glossy surface leaves things as they are.
    void upload(const GlossLight& light);

  private:
    const GlFunctions& gl_;
    GLuint maps_ = 0, cells_ = 0, suns_ = 0;
};

/// What glossy translucent primitives mirror: a texture for each roughness that the asset has.
/// Every call wants a SavedState around it.
class MirroredLight {
  public:
    explicit MirroredLight(const GlFunctions& gl) : gl_(gl) {}

    /// Black textures. `asset`: roughness is copied from it.
    void make(const formats::AssetView& asset, GlNames& names);

    /// Copies the light's maps; where it lacks one, that texture stays as it is.
    void upload(const SpecularLight& light);
    void turn(const Rotation& rotation) { rotation_ = rotation; }

    /// Of a primitive: the texture, 0 where it is not glossy, and the cone of its lobe.
    struct Lobe {
        GLuint texture = 0;
        float cosine = 1, sine = 0;
    };
    Lobe lobe_of(std::size_t primitive) const;

    const Rotation& rotation() const { return rotation_; }

  private:
    const GlFunctions& gl_;
    std::vector<float> roughness_;       // of each primitive, below 0 where it is not glossy
    std::vector<std::uint32_t> levels_;  // ascending
    std::vector<GLuint> textures_;       // one a level
    Rotation rotation_;
};

}  // namespace opaline::runtime
