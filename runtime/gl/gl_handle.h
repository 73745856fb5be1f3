#pragma once

#include <GL/glcorearb.h>

#include <utility>

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

}  // namespace opaline::runtime
