#include "runtime/embed_gl/gl_names.h"

#include <algorithm>
#include <array>
#include <cstdio>

#include "runtime/api_support.h"

namespace opaline::runtime {
namespace {

// Drivers stage an upload, and a copy of the whole may not fit beside it.
constexpr std::size_t kPiece = std::size_t{64} << 20;

std::size_t padded(std::size_t size) {
    return std::max<std::size_t>(16, (size + 15) / 16 * 16);
}

}  // namespace

std::string define(const char* name, const std::string& value) {
    return std::string("#define ") + name + " " + value + "\n";
}

std::string define(const char* name, std::size_t value) {
    return define(name, std::to_string(value));
}

GLuint GlNames::make_buffer(std::size_t size, GLenum usage) {
    GLuint name = 0;
    gl_->GenBuffers(1, &name);
    buffers_.push_back(name);
    gl_->BindBuffer(GL_COPY_WRITE_BUFFER, name);
    gl_->BufferData(GL_COPY_WRITE_BUFFER, static_cast<GLsizeiptr>(padded(size)), nullptr, usage);
    return name;
}

GLuint GlNames::make_buffer(std::span<const std::byte> bytes) {
    const GLuint name = make_buffer(bytes.size(), GL_STATIC_DRAW);
    fill_buffer(*gl_, name, 0, bytes);
    return name;
}

GLuint GlNames::make_program(const char* name, const std::string& defines,
                             std::initializer_list<StageSource> stages) {
    std::array<char, 300> log{};
    const GLuint program = gl_->CreateProgram();
    programs_.push_back(program);
    GLint is_done = GL_TRUE;
    for (const StageSource& source : stages) {
        const GLuint shader = gl_->CreateShader(source.stage);
        const std::array<const char*, 3> parts{gl_->shader_head(), defines.c_str(), source.text};
        gl_->ShaderSource(shader, static_cast<GLsizei>(parts.size()), parts.data(), nullptr);
        gl_->CompileShader(shader);
        gl_->GetShaderiv(shader, GL_COMPILE_STATUS, &is_done);
        if (is_done == GL_TRUE) {
            gl_->AttachShader(program, shader);
        } else {
            gl_->GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
        }
        gl_->DeleteShader(shader);  // with the program, where it is attached
        if (is_done != GL_TRUE) break;
    }
    if (is_done == GL_TRUE) {
        gl_->LinkProgram(program);
        gl_->GetProgramiv(program, GL_LINK_STATUS, &is_done);
        if (is_done == GL_TRUE) return program;
        gl_->GetProgramInfoLog(program, static_cast<GLsizei>(log.size()), nullptr, log.data());
    }
    std::array<char, 400> message{};
    std::snprintf(message.data(), message.size(), "the driver refuses the shader of %s: %s", name,
                  log.data());
    api::fail(OPALINE_GL_REFUSED, message.data());
    return 0;
}

GLuint GlNames::make_texture_of(GLenum target) {
    GLuint name = 0;
    gl_->GenTextures(1, &name);
    textures_.push_back(name);
    gl_->BindTexture(target, name);
    for (const GLenum filter : {GLenum{GL_TEXTURE_MIN_FILTER}, GLenum{GL_TEXTURE_MAG_FILTER}}) {
        gl_->TexParameteri(target, filter, GL_NEAREST);
    }
    return name;
}

GLuint GlNames::make_texture(std::uint32_t width, std::uint32_t height) {
    const GLuint name = make_texture_of(GL_TEXTURE_2D);
    gl_->TexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, static_cast<GLsizei>(width),
                      static_cast<GLsizei>(height));
    return name;
}

void GlNames::release() {
    for (const GLuint program : programs_)
        gl_->DeleteProgram(program);
    gl_->DeleteBuffers(static_cast<GLsizei>(buffers_.size()), buffers_.data());
    gl_->DeleteTextures(static_cast<GLsizei>(textures_.size()), textures_.data());
    programs_.clear();
    buffers_.clear();
    textures_.clear();
}

void fill_buffer(const GlFunctions& gl, GLuint buffer, std::size_t offset,
                 std::span<const std::byte> bytes) {
    gl.BindBuffer(GL_COPY_WRITE_BUFFER, buffer);
    for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
        gl.BufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset + at),
                         static_cast<GLsizeiptr>(std::min(kPiece, bytes.size() - at)),
                         bytes.data() + at);
    }
}

void fill_table(const GlFunctions& gl, GLuint texture, std::uint32_t width,
                std::span<const float> rgba) {
    gl.BindTexture(GL_TEXTURE_2D, texture);
    gl.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, static_cast<GLsizei>(width),
                  static_cast<GLsizei>(rgba.size() / 4 / width), 0, GL_RGBA, GL_FLOAT, rgba.data());
}

void fill_faces(const GlFunctions& gl, GLuint texture, std::size_t level, std::uint32_t size,
                const float* rgb) {
    const auto n = static_cast<GLsizei>(size);
    gl.BindTexture(GL_TEXTURE_2D_ARRAY, texture);
    gl.TexImage3D(GL_TEXTURE_2D_ARRAY, static_cast<GLint>(level), GL_RGB32F, n, n, 6, 0, GL_RGB,
                  GL_FLOAT, rgb);
}

void clear_buffer(const GlFunctions& gl, GLuint buffer, std::size_t size) {
    const std::vector<std::byte> zeros(std::min(kPiece, padded(size)));
    for (std::size_t at = 0; at < padded(size); at += zeros.size()) {
        fill_buffer(gl, buffer, at,
                    std::span(zeros).first(std::min(zeros.size(), padded(size) - at)));
    }
}

}  // namespace opaline::runtime
