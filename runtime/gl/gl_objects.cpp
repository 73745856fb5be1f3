#include "runtime/gl/gl_objects.h"

namespace opaline::runtime {
namespace {

// All levels; formats are told apart by the bits of their components.
std::size_t texture_bytes(GLuint texture) {
    constexpr GLint kMostLevels = 15;
    std::size_t bytes = 0;
    for (GLint level = 0; level < kMostLevels; ++level) {
        const auto ask = [&](GLenum what) {
            GLint value = 0;
            glGetTextureLevelParameteriv(texture, level, what, &value);
            return static_cast<std::size_t>(value);
        };
        const std::size_t texels =
            ask(GL_TEXTURE_WIDTH) * ask(GL_TEXTURE_HEIGHT) * ask(GL_TEXTURE_DEPTH);
        if (texels == 0) break;
        bytes += texels *
                 (ask(GL_TEXTURE_RED_SIZE) + ask(GL_TEXTURE_GREEN_SIZE) +
                  ask(GL_TEXTURE_BLUE_SIZE) + ask(GL_TEXTURE_ALPHA_SIZE)) /
                 8;
    }
    return bytes;
}

}  // namespace

formats::Status as_status(opaline_status status) {
    if (status == OPALINE_OK) return formats::ok_status();
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return formats::make_error(
        formats::ErrorKind::resource, {},
        std::string("OpenGL on ") + (renderer != nullptr ? renderer : "lost device"),
        opaline_last_error(), kRenderOnCpu);
}

formats::Status check_gl(const GlFunctions& gl, const char* doing) {
    return as_status(check_errors(gl, doing));
}

formats::Result<GLuint> make_program(GlNames& names, const char* name, const std::string& defines,
                                     const char* vertex, const char* fragment) {
    const GLuint program = names.make_program(
        name, defines, {{GL_VERTEX_SHADER, vertex}, {GL_FRAGMENT_SHADER, fragment}});
    if (program == 0) return as_status(OPALINE_GL_REFUSED).error();
    return program;
}

std::size_t resident_bytes(const GlNames& names) {
    std::size_t bytes = 0;
    for (const GLuint buffer : names.buffers()) {
        GLint64 size = 0;
        glGetNamedBufferParameteri64v(buffer, GL_BUFFER_SIZE, &size);
        bytes += static_cast<std::size_t>(size);
    }
    for (const GLuint texture : names.textures()) {
        bytes += texture_bytes(texture);
    }
    return bytes;
}

}  // namespace opaline::runtime
