#include "tests/runtime/embed_gl/host/host_picture.h"

#include <array>
#include <fstream>
#include <iterator>
#include <utility>

#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

constexpr GLsizei kRaysAcross = 64;

const char* const kWholeTarget = R"(
void main() {
    gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0);
}
)";

const char* const kSeeRays = R"(
uniform sampler2D rays;
layout(location = 0) out vec4 first_half;
layout(location = 1) out vec4 second_half;
void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec4 from = texelFetch(rays, ivec2(2 * at.x, at.y), 0);
    vec4 direction = texelFetch(rays, ivec2(2 * at.x + 1, at.y), 0);
    see(from.xyz, from.w, direction.xyz, direction.w, first_half, second_half);
}
)";

std::string version_of(HostApi api) {
    return api == HostApi::es_31        ? "#version 310 es\nprecision highp float;\n"
           : api == HostApi::desktop_43 ? "#version 430 core\n"
                                        : "#version 450 core\n";
}

}  // namespace

std::string read_functions(const std::string& file) {
    std::ifstream in(std::string(OPALINE_GLSL_DIR "/") + file);
    require(in.good(), file + " is not installed");
    return {std::istreambuf_iterator<char>(in), {}};
}

void attach_shader(unsigned program, unsigned stage, const std::vector<std::string>& parts) {
    std::vector<const char*> texts;
    for (const std::string& part : parts)
        texts.push_back(part.c_str());
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, static_cast<GLsizei>(texts.size()), texts.data(), nullptr);
    glCompileShader(shader);
    std::array<char, 2000> log{};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    require(log[0] == 0, log.data());
    glAttachShader(program, shader);
    glDeleteShader(shader);
}

unsigned make_float_target(int width, int height) {
    GLuint texture = 0;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, width, height);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return texture;
}

HostPicture::HostPicture(HostApi api, const std::vector<std::string>& files,
                         const std::string& defines, const std::string& see) {
    std::string functions;
    for (const std::string& name : files)
        functions += read_functions(name);
    program_ = glCreateProgram();
    attach_shader(program_, GL_VERTEX_SHADER, {version_of(api), kWholeTarget});
    attach_shader(program_, GL_FRAGMENT_SHADER,
                  {version_of(api), defines, functions, see, kSeeRays});
    glLinkProgram(program_);
    GLint is_linked = GL_FALSE;
    glGetProgramiv(program_, GL_LINK_STATUS, &is_linked);
    require(is_linked == GL_TRUE, "the program does not link");
    glUseProgram(program_);
    glGenVertexArrays(1, &array_);
    glGenFramebuffers(1, &framebuffer_);
}

HostPicture::HostPicture(HostPicture&& other) noexcept
    : program_(std::exchange(other.program_, 0)),
      array_(std::exchange(other.array_, 0)),
      framebuffer_(std::exchange(other.framebuffer_, 0)),
      textures_(std::move(other.textures_)),
      blocks_(other.blocks_) {}

HostPicture::~HostPicture() {
    if (program_ == 0) return;
    glUseProgram(0);  // else it stays until the library takes another one, which cannot go back
    glDeleteProgram(program_);
    glDeleteVertexArrays(1, &array_);
    glDeleteFramebuffers(1, &framebuffer_);
}

void HostPicture::bind_texture(const char* uniform, unsigned texture) {
    const GLint location = glGetUniformLocation(program_, uniform);
    require(location >= 0, uniform);
    textures_.emplace_back(location, texture);
}

void HostPicture::bind_block(const char* name, unsigned buffer) {
    const GLuint index = glGetUniformBlockIndex(program_, name);
    require(index != GL_INVALID_INDEX, name);
    glUniformBlockBinding(program_, index, blocks_);
    glBindBufferBase(GL_UNIFORM_BUFFER, blocks_++, buffer);
}

int HostPicture::use(const char* uniform) const {
    const GLint location = glGetUniformLocation(program_, uniform);
    require(location >= 0, uniform);
    glUseProgram(program_);
    return location;
}

void HostPicture::set_flag(const char* uniform, bool value) {
    glUniform1i(use(uniform), value ? 1 : 0);
}

void HostPicture::set_number(const char* uniform, float value) {
    glUniform1f(use(uniform), value);
}

void HostPicture::set_numbers(const char* uniform, float first, float second) {
    glUniform2f(use(uniform), first, second);
}

void HostPicture::set_pair(const char* uniform, int first, int second) {
    glUniform2i(use(uniform), first, second);
}

std::vector<float> HostPicture::draw(const std::vector<HostRay>& rays) {
    const auto rows = static_cast<GLsizei>((rays.size() + kRaysAcross - 1) / kRaysAcross);
    std::vector<HostRay> padded = rays;
    padded.resize(std::size_t{kRaysAcross} * static_cast<std::size_t>(rows), rays.front());
    glActiveTexture(GL_TEXTURE0);
    const std::array<GLuint, 3> textures{make_float_target(2 * kRaysAcross, rows),
                                         make_float_target(kRaysAcross, rows),
                                         make_float_target(kRaysAcross, rows)};
    glBindTexture(GL_TEXTURE_2D, textures[0]);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 2 * kRaysAcross, rows, GL_RGBA, GL_FLOAT,
                    padded.data());
    glUseProgram(program_);
    glUniform1i(glGetUniformLocation(program_, "rays"), 0);
    for (std::size_t i = 0; i < textures_.size(); ++i) {
        const auto unit = static_cast<GLint>(i + 1);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(GL_TEXTURE_2D, textures_[i].second);
        glUniform1i(textures_[i].first, unit);
    }
    glActiveTexture(GL_TEXTURE0);
    glBindVertexArray(array_);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    const std::array<GLenum, 2> targets{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    for (std::size_t i = 0; i < 2; ++i) {
        glFramebufferTexture2D(GL_FRAMEBUFFER, targets[i], GL_TEXTURE_2D, textures[i + 1], 0);
    }
    glDrawBuffers(2, targets.data());
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no framebuffer");
    glViewport(0, 0, kRaysAcross, rows);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    std::vector<float> drawn(8 * rays.size()), half(4 * padded.size());
    for (std::size_t i = 0; i < 2; ++i) {
        glReadBuffer(targets[i]);
        glReadPixels(0, 0, kRaysAcross, rows, GL_RGBA, GL_FLOAT, half.data());
        for (std::size_t ray = 0; ray < rays.size(); ++ray) {
            for (std::size_t c = 0; c < 4; ++c) {
                drawn[8 * ray + 4 * i + c] = half[4 * ray + c];
            }
        }
    }
    require(glGetError() == GL_NO_ERROR, "OpenGL reports an error");
    glDeleteTextures(3, textures.data());
    return drawn;
}

}  // namespace opaline::test
