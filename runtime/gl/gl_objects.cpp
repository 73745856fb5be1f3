#include "runtime/gl/gl_objects.h"

#include <algorithm>
#include <array>
#include <vector>

#include "runtime/embed_gl/gl_functions.h"

namespace opaline::runtime {
namespace {

using formats::ErrorKind;
using formats::make_error;

std::size_t padded(std::size_t size) {
    return std::max<std::size_t>(16, (size + 15) / 16 * 16);
}

template <class Get, class GetLog>
std::string info_log(GLuint name, Get get, GetLog get_log) {
    GLint length = 0;
    get(name, GL_INFO_LOG_LENGTH, &length);
    std::vector<char> text(static_cast<std::size_t>(std::max(length, 1)));
    get_log(name, static_cast<GLsizei>(text.size()), nullptr, text.data());
    return text.data();
}

formats::Result<GlShader> compile(const std::string& name, const std::string& defines,
                                  const StageSource& source) {
    GlShader shader(glCreateShader(source.stage));
    const std::array<const char*, 3> parts{"#version 450 core\n", defines.c_str(), source.text};
    glShaderSource(shader.name(), static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
    glCompileShader(shader.name());
    GLint compiled = GL_FALSE;
    glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
    if (compiled != GL_TRUE) {
        return make_error(
            ErrorKind::resource, {}, "OpenGL shader '" + name + "'",
            "the driver refuses it: " + info_log(shader.name(), glGetShaderiv, glGetShaderInfoLog),
            std::string("update the driver, or ") + kRenderOnCpu);
    }
    return shader;
}

}  // namespace

formats::Status check_gl(const std::string& doing) {
    std::string errors;
    // Bounded: a lost context reports errors for ever.
    for (int i = 0; i < 16; ++i) {
        const GLenum error = glGetError();
        if (error == GL_NO_ERROR) break;
        if (errors.find(gl_error_name(error)) == std::string::npos) {
            errors += (errors.empty() ? "" : ", ") + std::string(gl_error_name(error));
        }
    }
    if (errors.empty()) return formats::ok_status();
    const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
    return make_error(ErrorKind::resource, {},
                      std::string("OpenGL on ") + (renderer != nullptr ? renderer : "lost device"),
                      errors + " while " + doing, kRenderOnCpu);
}

GlBuffer make_buffer(std::span<const std::byte> bytes, std::size_t& resident) {
    GLuint name = 0;
    glCreateBuffers(1, &name);
    GlBuffer buffer(name);
    glNamedBufferStorage(name, static_cast<GLsizeiptr>(padded(bytes.size())), nullptr,
                         GL_DYNAMIC_STORAGE_BIT);
    // In pieces: drivers stage an upload, and a copy of the whole may not fit beside it.
    constexpr std::size_t kPiece = std::size_t{64} << 20;
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
        const std::size_t size = std::min(kPiece, bytes.size() - at);
        glNamedBufferSubData(name, static_cast<GLintptr>(at), static_cast<GLsizeiptr>(size),
                             bytes.data() + at);
    }
    resident += padded(bytes.size());
    return buffer;
}

formats::Result<GlProgram> make_program(const std::string& name, const std::string& defines,
                                        std::span<const StageSource> stages) {
    GlProgram program(glCreateProgram());
    std::vector<GlShader> shaders;
    for (const StageSource& source : stages) {
        auto shader = compile(name, defines, source);
        if (!shader) return shader.error();
        glAttachShader(program.name(), shader->name());
        shaders.push_back(std::move(shader).value());
    }
    glLinkProgram(program.name());
    GLint linked = GL_FALSE;
    glGetProgramiv(program.name(), GL_LINK_STATUS, &linked);
    if (linked != GL_TRUE) {
        return make_error(ErrorKind::resource, {}, "OpenGL program '" + name + "'",
                          "the driver cannot link it: " +
                              info_log(program.name(), glGetProgramiv, glGetProgramInfoLog),
                          std::string("update the driver, or ") + kRenderOnCpu);
    }
    for (const GlShader& shader : shaders) {
        glDetachShader(program.name(), shader.name());
    }
    return program;
}

}  // namespace opaline::runtime
