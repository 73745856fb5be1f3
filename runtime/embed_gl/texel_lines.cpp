#include "runtime/embed_gl/texel_lines.h"

#include <algorithm>
#include <cstdio>

#include "runtime/api_support.h"

namespace opaline::runtime {
namespace {

constexpr std::size_t kColumns = 2048;

}  // namespace

std::size_t TexelLines::rows_of(std::size_t texels) {
    return std::max<std::size_t>(1, (texels + kColumns - 1) / kColumns);
}

void TexelLines::make(GlNames& names) {
    name_ = names.make_table_texture();
    fill({});
}

void TexelLines::fill(std::span<const std::byte> bytes) {
    const std::size_t texels = bytes.size() / format_.bytes, whole = texels / kColumns;
    gl_.BindTexture(GL_TEXTURE_2D, name_);
    if (const std::size_t rows = rows_of(texels); rows != rows_) {
        gl_.TexImage2D(GL_TEXTURE_2D, 0, format_.internal, kColumns, static_cast<GLsizei>(rows), 0,
                       format_.format, format_.type, nullptr);
        rows_ = rows;
    }
    fill_rows(0, kColumns, whole, bytes);
    fill_rows(whole, texels % kColumns, 1, bytes);
}

void TexelLines::fill_rows(std::size_t first, std::size_t width, std::size_t height,
                           std::span<const std::byte> bytes) const {
    if (width * height == 0) return;
    gl_.TexSubImage2D(GL_TEXTURE_2D, 0, 0, static_cast<GLint>(first), static_cast<GLsizei>(width),
                      static_cast<GLsizei>(height), format_.format, format_.type,
                      bytes.data() + first * kColumns * format_.bytes);
}

opaline_status check_lines(const GlFunctions& gl, const char* what, std::size_t texels) {
    GLint limit = 0;
    gl.GetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
    if (TexelLines::rows_of(texels) <= static_cast<std::size_t>(std::max(limit, 0))) {
        return OPALINE_OK;
    }
    char text[160];
    std::snprintf(text, sizeof text, "%s: %lu texels, more than a texture of the driver has", what,
                  static_cast<unsigned long>(texels));
    return api::fail(OPALINE_GL_REFUSED, text);
}

}  // namespace opaline::runtime
