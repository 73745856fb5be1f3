#pragma once

#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "runtime/embed_gl/gl_names.h"

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

  private:
    GLuint upload(const formats::PreviewImage& image, GlNames& names) const;
    opaline_gl_image find(std::uint32_t image, formats::Wrap u, formats::Wrap v) const;

    const GlFunctions& gl_;
    std::vector<opaline_gl_images> primitive_;
    std::vector<GLuint> texture_;
};

}  // namespace opaline::runtime
