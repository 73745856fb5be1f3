#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

#include "runtime/embed_gl/gl_functions.h"

namespace opaline::runtime {

/// A shader of a program: the text follows GlFunctions::shader_head and the program's `defines`.
struct StageSource {
    GLenum stage = 0;
    const char* text = nullptr;
};

/// A line of a program's `defines`.
std::string define(const char* name, const std::string& value = {});
std::string define(const char* name, std::size_t value);

/// Owner of GL objects of one context. They are deleted by `release`, which needs that context;
/// without it they stay until the context goes. Everything here wants a SavedState around it.
class GlNames {
  public:
    explicit GlNames(const GlFunctions& gl) : gl_(&gl) {}

    /// A buffer of undefined content, padded to a multiple of 16 and never empty, so that a shader
    /// may read whole words and bind it in any case.
    GLuint make_buffer(std::size_t size, GLenum usage);
    GLuint make_buffer(std::span<const std::byte> bytes);
    template <class T>
    GLuint make_buffer_of(std::span<const T> values) {
        return make_buffer(std::as_bytes(values));
    }

    /// 0: the driver refuses it, opaline_last_error says why.
    GLuint make_program(const char* name, const std::string& defines,
                        std::initializer_list<StageSource> stages);

    /// RGBA32F, nearest filter.
    GLuint make_texture(std::uint32_t width, std::uint32_t height);

    /// Without texels yet, nearest filter; bound afterwards.
    GLuint make_array_texture() { return make_texture_of(GL_TEXTURE_2D_ARRAY); }
    GLuint make_table_texture() { return make_texture_of(GL_TEXTURE_2D); }

    void release();

    std::span<const GLuint> buffers() const { return buffers_; }
    std::span<const GLuint> textures() const { return textures_; }

  private:
    GLuint make_texture_of(GLenum target);

    const GlFunctions* gl_;
    std::vector<GLuint> buffers_, programs_, textures_;
};

/// Copies into a part of a buffer.
void fill_buffer(const GlFunctions& gl, GLuint buffer, std::size_t offset,
                 std::span<const std::byte> bytes);
/// Makes a 2D texture one of RGBA32F, `width` texels a row.
void fill_table(const GlFunctions& gl, GLuint texture, std::uint32_t width,
                std::span<const float> rgba);
/// Makes a level of a 2D array texture six layers of RGB32F.
void fill_faces(const GlFunctions& gl, GLuint texture, std::size_t level, std::uint32_t size,
                const float* rgb);
/// Zeros.
void clear_buffer(const GlFunctions& gl, GLuint buffer, std::size_t size);

}  // namespace opaline::runtime
