#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "runtime/embed_gl/gl_names.h"
#include "runtime/normal_maps/turned_light.h"

namespace opaline::runtime {

/// Images of surfaces as opaline_images.glsl samples them, and what each primitive takes of them.
/// Every call wants a SavedState around it.
class ImageTextures {
  public:
    explicit ImageTextures(const GlFunctions& gl) : gl_(gl) {}

    /// OPALINE_GL_REFUSED: an image is larger than the driver takes.
    opaline_status make(const formats::AssetView& asset, GlNames& names);

    /// Of a primitive, but for struct_size; zeros before `make`.
    opaline_gl_images of(std::uint32_t primitive) const;

    /// The light of normal maps, where there are some.
    void relight(const PartLights& lights, std::span<const formats::PrimitiveRecord> primitives);
    /// Of a primitive, but for struct_size; zeros where it has none.
    opaline_gl_normal_map normal_map_of(std::uint32_t primitive) const;

    GLuint srgb_table() const { return srgb_table_; }
    /// Of receivers, as in opaline_gl_images and opaline_gl_normal_map; 0: there are none.
    GLuint vertex_alpha() const { return vertex_alpha_; }
    GLuint tangent() const { return tangent_; }

  private:
    void make_normal_maps(const formats::AssetView& asset, GlNames& names);
    GLuint upload(const formats::PreviewImage& image, GlNames& names) const;
    opaline_gl_image find(std::uint32_t image, formats::Wrap u, formats::Wrap v) const;

    const GlFunctions& gl_;
    std::vector<opaline_gl_images> primitive_;
    std::vector<GLuint> texture_;
    std::map<std::uint32_t, opaline_gl_normal_map> normal_map_;  // of primitives; without light
    std::vector<formats::NormalMapRecord> record_;
    TurnedLights turned_;  // of the light that relit last
    GLuint vertex_alpha_ = 0, tangent_ = 0, srgb_table_ = 0;
};

}  // namespace opaline::runtime
