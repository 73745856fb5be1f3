#pragma once

#include <GL/glcorearb.h>

#include <cstddef>
#include <string>
#include <utility>

#include "formats/opal/result.h"
#include "runtime/embed_gl/gl_names.h"

namespace opaline::runtime {

/// Owner of one GL object; must be destroyed while its context is current. 0 is nothing.
template <void (*kDelete)(GLuint)>
class GlHandle {
  public:
    GlHandle() = default;
    explicit GlHandle(GLuint name) : name_(name) {}
    GlHandle(GlHandle&& other) noexcept : name_(std::exchange(other.name_, 0)) {}
    GlHandle& operator=(GlHandle&& other) noexcept {
        std::swap(name_, other.name_);
        return *this;
    }
    GlHandle(const GlHandle&) = delete;
    GlHandle& operator=(const GlHandle&) = delete;
    ~GlHandle() {
        if (name_ != 0) kDelete(name_);
    }

    GLuint name() const { return name_; }

  private:
    GLuint name_ = 0;
};

inline void delete_texture(GLuint name) {
    glDeleteTextures(1, &name);
}
inline void delete_framebuffer(GLuint name) {
    glDeleteFramebuffers(1, &name);
}
inline void delete_vertex_array(GLuint name) {
    glDeleteVertexArrays(1, &name);
}
using GlTexture = GlHandle<delete_texture>;
using GlFramebuffer = GlHandle<delete_framebuffer>;
using GlVertexArray = GlHandle<delete_vertex_array>;

/// What errors of OpenGL advise.
inline constexpr const char* kRenderOnCpu = "render on the CPU: `opaline render --backend cpu`";

/// Everything below needs a current OpenGL 4.5 context.

/// ok, or resource: the device, and what opaline_last_error says.
formats::Status as_status(opaline_status status);

/// check_errors: the GL errors since the last check.
formats::Status check_gl(const GlFunctions& gl, const char* doing);

/// A vertex and a fragment shader, after `defines`. Errors: resource with the driver's log.
formats::Result<GLuint> make_program(GlNames& names, const char* name, const std::string& defines,
                                     const char* vertex, const char* fragment);

/// In buffers and textures [bytes].
std::size_t resident_bytes(const GlNames& names);

}  // namespace opaline::runtime
