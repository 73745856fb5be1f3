// The functions that are installed for hosts' shaders, in shaders of a host: what each receiver
// sends to the eye, one texel each, beside opaline_shade_from.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <string>

#include "formats/opal/openness.h"
#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/host_context.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

constexpr GLsizei kWidth = 64;

// Both files, where the stage has use for both.
std::string installed_functions(GLenum stage) {
    std::string text;
    for (const char* name : {"opaline_surface.glsl", "opaline_gloss.glsl"}) {
        std::ifstream file(std::string(OPALINE_GLSL_DIR "/") + name);
        EXPECT_TRUE(file) << name;
        if (!text.empty() && stage == GL_VERTEX_SHADER) break;
        text.append(std::istreambuf_iterator<char>(file), {});
    }
    return text;
}

const char* const kHostVertex = R"(
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 base_color;
layout(location = 3) in vec3 radiance;
layout(location = 4) in vec2 open_axis;
layout(location = 5) in float open_fraction;
uniform vec3 eye;
uniform vec2 target;  // its size
flat out vec3 v_normal, v_to_eye, v_base_color, v_radiance;
flat out vec4 v_openness;
void main() {
    v_normal = normal;
    v_to_eye = eye - position;
    v_base_color = base_color;
    v_radiance = radiance;
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
uniform bool is_translucent, is_double_sided, is_mirroring;
uniform float eta;
uniform vec2 lobe;
uniform mat3 light_from_world;
uniform sampler2DArray mirrored_light;
uniform bool is_glossy;
uniform vec4 f0_f90;
uniform vec2 factors;
layout(location = 0) out vec4 color;
void main() {
    OpalineView view = opaline_view(v_normal, v_to_eye, is_double_sided);
    vec3 sent = opaline_diffuse(v_radiance, v_base_color);
    if (is_translucent) sent = opaline_translucent(v_radiance, v_base_color, view, eta);
    if (is_mirroring) {
        sent += opaline_mirrored(mirrored_light, light_from_world, view, eta, v_openness, lobe);
    }
    if (is_glossy) {
        OpalineGloss gloss = opaline_make_gloss(f0_f90, factors, v_base_color);
        sent = opaline_glossy_diffuse(gloss, v_radiance, v_base_color, view) +
               opaline_glossy_mirrored(gloss, light_from_world, view, v_openness);
    }
    color = vec4(sent, 1.0);
}
)";

GLuint compile_host(GLuint program, GLenum stage, bool is_es, const char* text) {
    const std::string functions = installed_functions(stage);
    EXPECT_FALSE(functions.empty());
    const std::array<const char*, 3> parts{
        is_es ? "#version 310 es\n"
              : "#version 330 core\n#extension GL_ARB_explicit_attrib_location : enable\n",
        functions.c_str(), text};
    const GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 3, parts.data(), nullptr);
    glCompileShader(shader);
    std::array<char, 2000> log{};
    glGetShaderInfoLog(shader, log.size(), nullptr, log.data());
    EXPECT_STREQ(log.data(), "");
    glAttachShader(program, shader);
    return shader;
}

void bind_host_attribute(GLuint location, GLuint buffer, GLint size, GLsizei stride) {
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    glVertexAttribPointer(location, size, GL_FLOAT, GL_FALSE, stride, nullptr);
    glEnableVertexAttribArray(location);
}

// Draws all receivers with a host's program, primitive by primitive.
std::vector<float> draw_receivers(const EmbeddedAsset& host, const opaline_gl* gl, bool is_es,
                                  const float* eye) {
    opaline_gl_objects objects{};
    objects.struct_size = sizeof objects;
    EXPECT_EQ(opaline_gl_get_objects(gl, &objects), OPALINE_OK);
    const auto rows = static_cast<GLsizei>(host.receivers() / kWidth + 1);
    GLuint array = 0, target = 0, framebuffer = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    bind_host_attribute(0, objects.position, 3, 12);
    bind_host_attribute(1, objects.normal, 3, 12);
    bind_host_attribute(2, objects.base_color, 3, 12);
    bind_host_attribute(3, objects.radiance, 3, 16);
    if (objects.openness != 0) {
        glBindBuffer(GL_ARRAY_BUFFER, objects.openness);
        glVertexAttribPointer(4, 2, GL_BYTE, GL_TRUE, 4, nullptr);
        glVertexAttribPointer(5, 1, GL_UNSIGNED_BYTE, GL_TRUE, 4, reinterpret_cast<void*>(2));
        glEnableVertexAttribArray(4);
        glEnableVertexAttribArray(5);
    }
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, kWidth, rows);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    EXPECT_EQ(glCheckFramebufferStatus(GL_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    glViewport(0, 0, kWidth, rows);
    const GLuint program = glCreateProgram();
    compile_host(program, GL_VERTEX_SHADER, is_es, kHostVertex);
    compile_host(program, GL_FRAGMENT_SHADER, is_es, kHostFragment);
    glLinkProgram(program);
    glUseProgram(program);
    const auto uniform = [&](const char* name) { return glGetUniformLocation(program, name); };
    glUniform3fv(uniform("eye"), 1, eye);
    GLint unit = 1;
    for (const auto& [name, texture] : {std::pair{"opaline_light_maps", objects.light_maps},
                                        {"opaline_cells", objects.cells},
                                        {"opaline_sun_table", objects.sun_table},
                                        {"opaline_albedo", objects.albedo}}) {
        EXPECT_GE(uniform(name), 0) << name;
        glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
        glBindTexture(unit == 1 ? GL_TEXTURE_2D_ARRAY : GL_TEXTURE_2D, texture);
        glUniform1i(uniform(name), unit++);
    }
    glActiveTexture(GL_TEXTURE0);
    glUniform2f(uniform("target"), kWidth, static_cast<float>(rows));
    for (std::uint32_t p = 0; p < opaline_asset_primitive_count(host.asset()); ++p) {
        opaline_primitive_info info{};
        opaline_primitive_shading shading{};
        opaline_gl_surface surface{};
        info.struct_size = sizeof info;
        shading.struct_size = sizeof shading;
        surface.struct_size = sizeof surface;
        EXPECT_EQ(opaline_asset_primitive(host.asset(), p, &info), OPALINE_OK);
        EXPECT_EQ(opaline_asset_primitive_shading(host.asset(), p, &shading), OPALINE_OK);
        EXPECT_EQ(opaline_gl_get_surface(gl, p, &surface), OPALINE_OK);
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
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return texels;
}

formats::Asset make_glossy_ones() {
    formats::Asset asset = make_asset(8, 8);
    add_primitive(asset, make_sphere({0, 0, 0}, 1, 9, 7), {.bands = 3, .details = 37});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 12, 9),
                  {.bands = 3, .details = 20, .eta = 1.3f, .terms = 9});
    add_primitive(asset, make_sheet({0, 3, 0}, {1, 0, 0}, {0, 0.7f, 0.4f}, 6, 1),
                  {.bands = 3, .eta = 1.5f, .terms = 4, .is_double_sided = true});
    add_primitive(asset, make_sphere({0, 0, 3}, 1, 9, 8), {.eta = 1.4f, .is_double_sided = true});
    add_primitive(asset, make_sheet({2, 3, 0}, {1, 0, 0}, {0, 0.7f, 0.4f}, 5, 1),
                  {.bands = 3, .is_sheet = true});
    // A metal, a dielectric, and a thin-walled one whose lobe is summed up both ways.
    add_primitive(asset, make_sphere({6, 0, 0}, 1, 9, 7), {.bands = 3, .details = 37});
    add_primitive(asset, make_sphere({6, 3, 0}, 1, 9, 7), {.bands = 3, .details = 37});
    add_primitive(asset, make_sheet({6, 0, 3}, {1, 0, 0}, {0, 0.7f, 0.4f}, 5, 1),
                  {.bands = 3, .is_double_sided = true, .is_sheet = true});
    asset.gloss.resize(asset.primitives.size());
    const std::array<formats::GlossRecord, 3> kinds{{{1, 0.2f, {0.04f, 0.04f, 0.04f}, 1},
                                                     {0, 0.8f, {0.04f, 0.05f, 0.06f}, 0.9f},
                                                     {0.3f, 0.45f, {0.04f, 0.04f, 0.04f}, 1}}};
    std::copy(kinds.begin(), kinds.end(), asset.gloss.end() - 3);
    asset.roughness.assign(asset.primitives.size(), formats::kNotGlossy);
    asset.roughness[1] = 0.1f;
    asset.roughness[2] = asset.roughness[3] = 0.45f;
    for (std::size_t v = 0; v < asset.normal.size(); ++v) {
        const float a = static_cast<float>(v);
        asset.openness.push_back(formats::encode_openness(
            asset.normal[v] + 0.3f * formats::Vec3{std::sin(a), std::cos(a), 0},
            0.3f + 0.7f * std::abs(std::sin(0.37f * a))));
    }
    return asset;
}

class EmbedGlSurface : public EmbedGl {};

TEST_P(EmbedGlSurface, FunctionsForHostsMakeWhatTheCpuDoes) {
    const EmbeddedAsset host(make_glossy_ones());
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_MESH, &gl), OPALINE_OK)
        << opaline_last_error();
    // The light as it is; turned, which leaves maps of what is mirrored as they are; another one.
    for (int step = 0; step < 3; ++step) {
        const float turned[9] = {0, 0, -1, 0.6f, 0.8f, 0, 0.8f, -0.6f, 0}, sky[3] = {2, 3, 4};
        if (step == 1) {
            ASSERT_EQ(opaline_light_set_rotation(host.light(), turned), OPALINE_OK);
        } else if (step == 2) {
            ASSERT_EQ(opaline_light_set_lat_long(host.light(), sky, 1, 1), OPALINE_OK);
        }
        const std::array<float, 3> eye =
            step == 1 ? std::array<float, 3>{2, 1, 7} : std::array<float, 3>{-3, 4, -5};
        ASSERT_EQ(opaline_gl_look_from(gl, eye.data()), OPALINE_OK);
        ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK) << opaline_last_error();
        const std::vector<float> drawn =
            draw_receivers(host, gl, GetParam() == HostApi::es_31, eye.data());
        std::vector<float> cpu(3 * std::size_t{host.receivers()});
        ASSERT_EQ(opaline_shade_from(host.asset(), host.light(), 0, eye.data(), 0, host.receivers(),
                                     cpu.data(), cpu.size()),
                  OPALINE_OK);
        const float brightest = *std::max_element(cpu.begin(), cpu.end());
        float largest = 0;
        for (std::size_t i = 0; i < cpu.size(); ++i) {
            const float difference = std::abs(cpu[i] - drawn[i / 3 * 4 + i % 3]);
            EXPECT_LE(difference, 1e-5f * brightest) << "receiver " << i / 3;
            largest = std::max(largest, difference);
        }
        std::cout << "[ agreement] " << largest / brightest << "\n";
    }
    opaline_gl_surface surface{};
    surface.struct_size = sizeof surface;
    EXPECT_EQ(opaline_gl_get_surface(gl, 8, &surface), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_surface(nullptr, 0, &surface), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_surface(gl, 0, nullptr), OPALINE_INVALID_ARGUMENT);
    surface.struct_size = 3;
    EXPECT_EQ(opaline_gl_get_surface(gl, 0, &surface), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlSurface, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
