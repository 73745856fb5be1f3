#include "bake/cli/view/picture_painter.h"

#include <GL/glcorearb.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/cli/messages.h"

namespace opaline::cli {
namespace {

// The tone mapper and the encoding are those of runtime/picture/tone_map.cpp.
constexpr const char* kVertexText = R"glsl(#version 330 core
void main() {
    vec2 corner = vec2(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0);
    gl_Position = vec4(corner, 0.0, 1.0);
}
)glsl";

constexpr const char* kFragmentText = R"glsl(#version 330 core
uniform sampler2D first, second;
uniform vec2 size;
uniform float scale, split, gain;
uniform bool is_neutral;
out vec4 color;

vec3 tame(vec3 c) {
    return vec3(c.r > 0.0 ? min(c.r, 1e37) : 0.0, c.g > 0.0 ? min(c.g, 1e37) : 0.0,
                c.b > 0.0 ? min(c.b, 1e37) : 0.0);
}

vec3 neutral(vec3 c) {
    const float reflectance = 0.04, shoulder = 0.76, desaturation = 0.15;
    float least = min(c.r, min(c.g, c.b));
    c -= least < 0.08 ? least - least * least / 0.16 : reflectance;
    float peak = max(c.r, max(c.g, c.b));
    if (peak <= shoulder) return c;
    const float room = 1.0 - shoulder;
    vec3 compressed = mix(c, 1.0 - room * room / (max(c, shoulder) + room - shoulder),
                          greaterThan(c, vec3(shoulder)));
    float new_peak = max(compressed.r, max(compressed.g, compressed.b));
    float keep = 1.0 / (desaturation * (peak - new_peak) + 1.0);
    return clamp(new_peak + keep * (compressed - new_peak), 0.0, 1.0);
}

vec3 encode(vec3 c) {
    vec3 curve = 1.055 * pow(max(c, vec3(0.0031308)), vec3(1.0 / 2.4)) - 0.055;
    return mix(curve, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

vec3 display(sampler2D picture, vec2 at) {
    vec3 c = tame(scale * texture(picture, at).rgb);
    return encode(is_neutral ? neutral(c) : min(c, vec3(1.0)));
}

void main() {
    vec2 at = vec2(gl_FragCoord.x, size.y - gl_FragCoord.y) / size;
    float edge = split * size.x;
    bool is_second = gl_FragCoord.x > edge;
    if (is_second && gain > 0.0) {
        vec3 apart = abs(display(first, at) - display(second, at));
        float heat = 3.0 * gain * max(apart.r, max(apart.g, apart.b));
        color = vec4(clamp(vec3(heat, heat - 1.0, heat - 2.0), 0.0, 1.0), 1.0);
    } else if (is_second) {
        color = vec4(display(second, at), 1.0);
    } else {
        color = vec4(display(first, at), 1.0);
    }
}
)glsl";

// Before anything else was made: a program that ends leaves nothing to delete.
[[noreturn]] void refuse_gl(const char* doing, std::string log) {
    refuse(formats::make_error(formats::ErrorKind::resource, "", "window",
                               std::string(doing) + ": " + std::move(log),
                               "install a driver with OpenGL 3.3, or use `opaline render`"));
}

GLuint compile_stage(GLenum stage, const char* text) {
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint is_compiled = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &is_compiled);
    if (is_compiled != 0) return shader;
    std::string log(4096, '\0');
    GLsizei written = 0;
    glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &written, log.data());
    log.resize(static_cast<std::size_t>(written));
    refuse_gl("compiling the tone mapper", std::move(log));
}

GLuint link_program() {
    const GLuint program = glCreateProgram();
    for (const GLuint shader : {compile_stage(GL_VERTEX_SHADER, kVertexText),
                                compile_stage(GL_FRAGMENT_SHADER, kFragmentText)}) {
        glAttachShader(program, shader);
        glDeleteShader(shader);
    }
    glLinkProgram(program);
    GLint is_linked = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &is_linked);
    if (is_linked == 0) refuse_gl("linking the tone mapper", "failed");
    return program;
}

void set_filter(GLenum filter) {
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, static_cast<GLint>(filter));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, static_cast<GLint>(filter));
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void copy_frame(GLuint from, GLuint to, std::uint32_t width, std::uint32_t height) {
    const auto columns = static_cast<GLint>(width), rows = static_cast<GLint>(height);
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, from);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, to);
    glBlitFramebuffer(0, 0, columns, rows, 0, 0, columns, rows, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

}  // namespace

PicturePainter::PicturePainter() : program_(link_program()) {
    glGenVertexArrays(1, &vertex_array_);
    glGenFramebuffers(2, frame_);
    glGenTextures(2, image_);
    glGenTextures(2, picture_);
}

PicturePainter::~PicturePainter() {
    glDeleteProgram(program_);
    glDeleteVertexArrays(1, &vertex_array_);
    glDeleteFramebuffers(2, frame_);
    glDeleteTextures(2, image_);
    glDeleteTextures(2, picture_);
}

void PicturePainter::upload(int which, const runtime::Picture& picture) {
    is_there_[which] = !picture.pixel.empty();
    mapped_.reset();
    if (!is_there_[which]) return;
    picture_width_[which] = picture.width;
    picture_height_[which] = picture.height;
    glBindTexture(GL_TEXTURE_2D, picture_[which]);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, static_cast<GLsizei>(picture.width),
                 static_cast<GLsizei>(picture.height), 0, GL_RGB, GL_FLOAT, picture.pixel.data());
}

void PicturePainter::resize(std::uint32_t width, std::uint32_t height) {
    if (width == width_ && height == height_) return;
    width_ = width;
    height_ = height;
    mapped_.reset();
    for (const int which : {kMapped, kImage}) {
        glBindTexture(GL_TEXTURE_2D, image_[which]);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, static_cast<GLsizei>(width),
                     static_cast<GLsizei>(height), 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
        set_filter(GL_NEAREST);
        glBindFramebuffer(GL_FRAMEBUFFER, frame_[which]);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, image_[which],
                               0);
    }
}

void PicturePainter::paint(std::uint32_t width, std::uint32_t height, const PaintLook& look) {
    resize(width, height);
    if (mapped_ != look) map_tones(look);
    mapped_ = look;
    copy_frame(frame_[kMapped], frame_[kImage], width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, frame_[kImage]);
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
}

void PicturePainter::map_tones(const PaintLook& look) const {
    const std::uint32_t width = width_, height = height_;
    glBindFramebuffer(GL_FRAMEBUFFER, frame_[kMapped]);
    glViewport(0, 0, static_cast<GLsizei>(width), static_cast<GLsizei>(height));
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glClearColor(0.1f, 0.1f, 0.1f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    if (!is_there_[0]) return;
    for (int which = 0; which < 2; ++which) {
        const bool is_exact = picture_width_[which] == width && picture_height_[which] == height;
        glActiveTexture(which == 0 ? GL_TEXTURE0 : GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_2D, picture_[is_there_[which] ? which : 0]);
        set_filter(is_exact ? GL_NEAREST : GL_LINEAR);
    }
    glActiveTexture(GL_TEXTURE0);
    glUseProgram(program_);
    const auto uniform = [this](const char* name) { return glGetUniformLocation(program_, name); };
    glUniform1i(uniform("first"), 0);
    glUniform1i(uniform("second"), 1);
    glUniform2f(uniform("size"), static_cast<float>(width), static_cast<float>(height));
    glUniform1f(uniform("scale"), std::exp2(look.exposure));
    glUniform1f(uniform("split"), is_there_[1] ? look.split : 2.0f);
    glUniform1f(uniform("gain"), look.difference_gain);
    glUniform1i(uniform("is_neutral"), look.tone_map == runtime::ToneMap::neutral ? 1 : 0);
    glBindVertexArray(vertex_array_);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

runtime::DisplayPicture PicturePainter::read() const {
    runtime::DisplayPicture picture{width_, height_, {}};
    picture.rgba.resize(std::size_t{4} * width_ * height_);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, frame_[kImage]);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glPixelStorei(GL_PACK_ROW_LENGTH, 0);
    glReadPixels(0, 0, static_cast<GLsizei>(width_), static_cast<GLsizei>(height_), GL_RGBA,
                 GL_UNSIGNED_BYTE, picture.rgba.data());
    const auto row = static_cast<std::ptrdiff_t>(std::size_t{4} * width_);
    for (std::uint32_t y = 0; y < height_ / 2; ++y) {  // row 0 is the lowest one in OpenGL
        std::swap_ranges(picture.rgba.begin() + y * row, picture.rgba.begin() + (y + 1) * row,
                         picture.rgba.begin() + (height_ - 1 - y) * row);
    }
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) {
        picture.rgba[i] = 255;  // controls blend into alpha too
    }
    return picture;
}

void PicturePainter::show() const {
    copy_frame(frame_[kImage], 0, width_, height_);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

}  // namespace opaline::cli
