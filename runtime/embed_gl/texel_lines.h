#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "runtime/embed_gl/gl_names.h"

namespace opaline::runtime {

/// How a texel of an array in a texture is stored.
struct TexelFormat {
    GLint internal = 0;
    GLenum format = 0, type = 0;
    std::size_t bytes = 0;
};
inline constexpr TexelFormat kWordTexel{GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, 4};
inline constexpr TexelFormat kFloatTexel{GL_R32F, GL_RED, GL_FLOAT, 4};
inline constexpr TexelFormat kColorTexel{GL_RGB32F, GL_RGB, GL_FLOAT, 12};

/// An array in a texture of 2048 columns, for shaders where buffer blocks are not promised; at
/// least a row. Every call wants a SavedState around it.
class TexelLines {
  public:
    TexelLines(const GlFunctions& gl, const TexelFormat& format) : gl_(gl), format_(format) {}

    void make(GlNames& names);
    /// Of any size; as many rows as the last time cost no new memory.
    void fill(std::span<const std::byte> bytes);
    template <class T>
    void fill_of(std::span<const T> values) {
        fill(std::as_bytes(values));
    }

    GLuint name() const { return name_; }

    static std::size_t rows_of(std::size_t texels);

  private:
    void fill_rows(std::size_t first, std::size_t width, std::size_t height,
                   std::span<const std::byte> bytes) const;

    const GlFunctions& gl_;
    const TexelFormat& format_;
    GLuint name_ = 0;
    std::size_t rows_ = 0;
};

/// Whether a texture of the driver has room for so many texels; if not, `what` is named.
opaline_status check_lines(const GlFunctions& gl, const char* what, std::size_t texels);

}  // namespace opaline::runtime
