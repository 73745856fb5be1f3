#include "runtime/embed_gl/saved_state.h"

#include <cstddef>

namespace opaline::runtime {
namespace {

// Of images in memory; OpenGL ES has all but the last two, whose state is 0 there.
constexpr std::array<GLenum, 8> kPixelStore{
    GL_UNPACK_ALIGNMENT,   GL_UNPACK_ROW_LENGTH,   GL_UNPACK_SKIP_ROWS,  GL_UNPACK_SKIP_PIXELS,
    GL_UNPACK_SKIP_IMAGES, GL_UNPACK_IMAGE_HEIGHT, GL_UNPACK_SWAP_BYTES, GL_UNPACK_LSB_FIRST};

std::size_t pixel_store_count(const GlFunctions& gl) {
    return gl.is_es ? kPixelStore.size() - 2 : kPixelStore.size();
}

}  // namespace

SavedState::SavedState(const GlFunctions& gl) : gl_(gl) {
    gl.GetIntegerv(GL_CURRENT_PROGRAM, &program_);
    gl.GetIntegerv(GL_SHADER_STORAGE_BUFFER_BINDING, &storage_);
    gl.GetIntegerv(GL_COPY_WRITE_BUFFER_BINDING, &copy_);
    gl.GetIntegerv(GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_);
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D, &texture_);
    gl.GetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &array_);
    for (GLuint i = 0; i < kStorageBindings; ++i) {
        gl.GetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, i, &binding_[i].buffer);
        gl.GetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, i, &binding_[i].offset);
        gl.GetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, i, &binding_[i].size);
    }
    for (std::size_t i = 0; i < pixel_store_count(gl); ++i) {
        gl.GetIntegerv(kPixelStore[i], &pixel_store_[i]);
        gl.PixelStorei(kPixelStore[i], kPixelStore[i] == GL_UNPACK_ALIGNMENT ? 4 : 0);
    }
    gl.BindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
}

SavedState::~SavedState() {
    gl_.UseProgram(static_cast<GLuint>(program_));
    for (GLuint i = 0; i < kStorageBindings; ++i) {
        const Binding& binding = binding_[i];
        // Of size 0: the whole buffer, whatever its size; or none.
        if (binding.size == 0) {
            gl_.BindBufferBase(GL_SHADER_STORAGE_BUFFER, i, static_cast<GLuint>(binding.buffer));
        } else {
            gl_.BindBufferRange(GL_SHADER_STORAGE_BUFFER, i, static_cast<GLuint>(binding.buffer),
                                static_cast<GLintptr>(binding.offset),
                                static_cast<GLsizeiptr>(binding.size));
        }
    }
    gl_.BindBuffer(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(storage_));
    gl_.BindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(copy_));
    gl_.BindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack_));
    gl_.BindTexture(GL_TEXTURE_2D, static_cast<GLuint>(texture_));
    gl_.BindTexture(GL_TEXTURE_2D_ARRAY, static_cast<GLuint>(array_));
    for (std::size_t i = 0; i < pixel_store_count(gl_); ++i) {
        gl_.PixelStorei(kPixelStore[i], pixel_store_[i]);
    }
}

}  // namespace opaline::runtime
