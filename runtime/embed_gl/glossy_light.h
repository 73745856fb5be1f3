#pragma once

#include "runtime/embed_gl/gl_names.h"
#include "runtime/gloss_light.h"

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

}  // namespace opaline::runtime
