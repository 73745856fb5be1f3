#pragma once

#include <array>

#include "runtime/embed_gl/gl_functions.h"

namespace opaline::runtime {

/// Buffer blocks that the library's shaders bind, from 0 on.
inline constexpr GLuint kStorageBindings = 4;

/// Everything of the host's GL state that the library changes; put back when it goes. For uploads
/// it sets pixel storage as they want it: packed rows of whole words, from memory.
class SavedState {
  public:
    explicit SavedState(const GlFunctions& gl);
    SavedState(const SavedState&) = delete;
    SavedState& operator=(const SavedState&) = delete;
    ~SavedState();

  private:
    struct Binding {
        GLint buffer = 0;
        GLint64 offset = 0, size = 0;
    };
    const GlFunctions& gl_;
    GLint program_ = 0, storage_ = 0, copy_ = 0, unpack_ = 0, texture_ = 0, array_ = 0;
    std::array<Binding, kStorageBindings> binding_;
    std::array<GLint, 8> pixel_store_{};
};

}  // namespace opaline::runtime
