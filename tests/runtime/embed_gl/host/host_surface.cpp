#include "tests/runtime/embed_gl/host/host_surface.h"

#include <cstdint>
#include <string>
#include <utility>

#include "tests/runtime/embed_gl/host/host_picture.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

constexpr GLsizei kWidth = 64;

const char* const kHostVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 base_color;
layout(location = 3) in vec3 radiance;
layout(location = 4) in vec2 open_axis;
layout(location = 5) in float open_fraction;
layout(location = 6) in vec2 texcoord;
uniform vec3 eye;
uniform vec2 target;  // its size
flat out vec3 v_normal, v_to_eye, v_base_color, v_radiance;
flat out vec4 v_openness;
flat out vec2 v_texcoord;
void main() {
    v_normal = normal;
    v_to_eye = eye - position;
    v_base_color = base_color;
    v_radiance = radiance;
    v_texcoord = texcoord;
    v_openness = vec4(opaline_decode_axis(open_axis), open_fraction);
    vec2 texel = vec2(gl_VertexID % 64, gl_VertexID / 64) + 0.5;
    gl_Position = vec4(2.0 * texel / target - 1.0, 0.0, 1.0);
#ifdef GL_ES
    gl_PointSize = 1.0;
#endif
}
)";

const char* const kHostFragment = R"(
flat in vec3 v_normal, v_to_eye, v_base_color, v_radiance;
flat in vec4 v_openness;
flat in vec2 v_texcoord;
uniform bool is_translucent, is_double_sided, is_mirroring;
uniform float eta;
uniform vec2 lobe;
uniform mat3 light_from_world;
uniform sampler2DArray mirrored_light;
uniform bool is_glossy;
uniform vec4 f0_f90;
uniform vec2 factors;
uniform vec3 emission;
uniform usampler2D base_color_image, gloss_image, emission_image;
uniform ivec3 base_color_wrap, gloss_wrap, emission_wrap;  // z: there is an image
layout(location = 0) out vec4 color;
vec3 sample_or_one(usampler2D image, ivec3 wrap, bool is_srgb) {
    return wrap.z == 0 ? vec3(1.0) : opaline_sample_image(image, v_texcoord, wrap.xy, is_srgb);
}
void main() {
    vec3 base_color = v_base_color * sample_or_one(base_color_image, base_color_wrap, true);
    OpalineView view = opaline_view(v_normal, v_to_eye, is_double_sided);
    vec3 sent = opaline_diffuse(v_radiance, base_color);
    if (is_translucent) sent = opaline_translucent(v_radiance, base_color, view, eta);
    if (is_mirroring) {
        sent = opaline_translucent(v_radiance, base_color, view, eta, v_openness, lobe) +
               opaline_mirrored(mirrored_light, light_from_world, view, eta, v_openness, lobe);
    }
    if (is_glossy) {
        OpalineGloss gloss =
            opaline_make_gloss(f0_f90, factors * sample_or_one(gloss_image, gloss_wrap, false).bg,
                               base_color);
        sent = opaline_glossy_diffuse(gloss, v_radiance, base_color, view) +
               opaline_glossy_mirrored(gloss, light_from_world, view, v_openness);
        if (gloss_wrap.z == 0) {
            sent += opaline_glossy_mirrored_surfaces(gloss, v_radiance, view, v_openness);
        }
    }
    sent += emission * sample_or_one(emission_image, emission_wrap, true);
    color = vec4(sent, 1.0);
}
)";

void bind_host_attribute(GLuint location, GLuint buffer, GLint size, GLsizei stride) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, stride, nullptr);
    glEnableVertexAttribArray(location);
}

}  // namespace

std::vector<float> draw_receivers(const opaline_asset* asset, const opaline_gl* gl, HostApi api,
                                  const float* eye) {
    const auto objects = filled<opaline_gl_objects>(opaline_gl_get_objects, gl);
    const auto rows = static_cast<GLsizei>(opaline_asset_receiver_count(asset) / kWidth + 1);
    GLuint array = 0, framebuffer = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    bind_host_attribute(0, objects.position, 3, 12);
    bind_host_attribute(1, objects.normal, 3, 12);
    bind_host_attribute(2, objects.base_color, 3, 12);
    bind_host_attribute(3, objects.radiance, 3, 16);
    if (objects.texcoord != 0) bind_host_attribute(6, objects.texcoord, 2, 8);
    if (objects.openness != 0) {
        glBindBuffer(GL_ARRAY_BUFFER, objects.openness);
        glVertexAttribPointer(4, 2, GL_BYTE, GL_TRUE, 4, nullptr);
        glVertexAttribPointer(5, 1, GL_UNSIGNED_BYTE, GL_TRUE, 4, reinterpret_cast<void*>(2));
        glEnableVertexAttribArray(4);
        glEnableVertexAttribArray(5);
    }
    const GLuint target = make_float_target(kWidth, rows);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    require(glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE, "no framebuffer");
    glViewport(0, 0, kWidth, rows);
    const GLuint program = glCreateProgram();
    const std::string version =
        api == HostApi::es_31
            ? "#version 310 es\n"
            : "#version 330 core\n#extension GL_ARB_explicit_attrib_location : enable\n";
    const std::string surface_functions = read_functions("opaline_surface.glsl");
    attach_shader(program, GL_VERTEX_SHADER, {version, surface_functions, kHostVertex});
    attach_shader(program, GL_FRAGMENT_SHADER,
                  {version, surface_functions, read_functions("opaline_gloss.glsl"),
                   read_functions("opaline_images.glsl"), kHostFragment});
    glLinkProgram(program);
    glUseProgram(program);
    const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUniform3fv(uniform("eye"), 1, eye);
    GLint unit = 1;
    for (const auto& [name, texture] : {std::pair{"opaline_light_maps", objects.light_maps},
                                        {"opaline_cells", objects.cells},
                                        {"opaline_sun_table", objects.sun_table},
                                        {"opaline_albedo", objects.albedo}}) {
        require(uniform(name) >= 0, name);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(unit == 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, texture);
        glUniform1i(uniform(name), unit++);
    }
    glActiveTexture(GL_TEXTURE0);
    glUniform2f(uniform("target"), kWidth, static_cast<float>(rows));
    const auto bind_image = [&](const char* image, const char* wrap, const opaline_gl_image& from,
                                GLint image_unit) {
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(image_unit));
        glBindTexture(GL_TEXTURE_2D, from.texture);
        glUniform1i(uniform(image), image_unit);
        glUniform3i(uniform(wrap), from.wrap[0], from.wrap[1], from.texture != 0 ? 1 : 0);
    };
    for (std::uint32_t p = 0; p < opaline_asset_primitive_count(asset); ++p) {
        const auto info = filled<opaline_primitive_info>(opaline_asset_primitive, asset, p);
        const auto shading =
            filled<opaline_primitive_shading>(opaline_asset_primitive_shading, asset, p);
        const auto emission =
            filled<opaline_primitive_emission>(opaline_asset_primitive_emission, asset, p);
        const auto surface = filled<opaline_gl_surface>(opaline_gl_get_surface, gl, p);
        const auto images = filled<opaline_gl_images>(opaline_gl_get_images, gl, p);
        bind_image("base_color_image", "base_color_wrap", images.base_color, unit);
        bind_image("gloss_image", "gloss_wrap", images.gloss, unit + 1);
        bind_image("emission_image", "emission_wrap", images.emission, unit + 2);
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit + 3));
        glBindTexture(GL_TEXTURE_2D, images.srgb_table);
        glUniform1i(uniform("opaline_srgb_table"), unit + 3);
        glActiveTexture(GL_TEXTURE0);
        glUniform3fv(uniform("emission"), 1, emission.radiance);
        glUniform1i(uniform("is_translucent"), shading.shading == OPALINE_SHADING_TRANSLUCENT);
        glUniform1i(uniform("is_double_sided"), static_cast<GLint>(info.double_sided));
        glUniform1i(uniform("is_mirroring"), surface.mirrored_light != 0);
        glUniform1f(uniform("eta"), shading.eta);
        glUniform2fv(uniform("lobe"), 1, surface.lobe);
        glUniformMatrix3fv(uniform("light_from_world"), 1, GL_FALSE, surface.light_from_world);
        glUniform1i(uniform("is_glossy"), static_cast<GLint>(surface.is_glossy));
        glUniform4fv(uniform("f0_f90"), 1, surface.f0_f90);
        glUniform2fv(uniform("factors"), 1, surface.factors);
        glBindTexture(GL_TEXTURE_2D_ARRAY, surface.mirrored_light);
        glDrawArrays(GL_POINTS, static_cast<GLint>(info.first_receiver),
                     static_cast<GLsizei>(info.receiver_count));
    }
    std::vector<float> texels(std::size_t{4} * kWidth * static_cast<std::size_t>(rows));
    glReadPixels(0, 0, kWidth, rows, GL_RGBA, GL_FLOAT, texels.data());
    require(glGetError() == GL_NO_ERROR, "OpenGL reports an error");
    glUseProgram(0);  // else it stays until the library takes another one, which cannot go back
    glDeleteProgram(program);
    glDeleteTextures(1, &target);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteVertexArrays(1, &array);
    return texels;
}

}  // namespace opaline::test
