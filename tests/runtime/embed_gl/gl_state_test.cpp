// The host's GL state is the same before and after every call.
#include <gtest/gtest.h>

#include <array>
#include <map>
#include <string>
#include <utility>

#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/volumes/synthetic_volume.h"
#include "tests/support/cloud_layers.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

constexpr GLuint kUnits = 4, kBlocks = 6;

struct StateName {
    GLenum name;
    const char* text;
    bool is_in_es = true;
};
#define OPALINE_STATE(name) \
    { name, #name }
#define OPALINE_DESKTOP_STATE(name) \
    { name, #name, false }

constexpr StateName kStates[] = {
    OPALINE_STATE(GL_CURRENT_PROGRAM),
    OPALINE_STATE(GL_PROGRAM_PIPELINE_BINDING),
    OPALINE_STATE(GL_VERTEX_ARRAY_BINDING),
    OPALINE_STATE(GL_DRAW_FRAMEBUFFER_BINDING),
    OPALINE_STATE(GL_READ_FRAMEBUFFER_BINDING),
    OPALINE_STATE(GL_RENDERBUFFER_BINDING),
    OPALINE_STATE(GL_ACTIVE_TEXTURE),
    OPALINE_STATE(GL_ARRAY_BUFFER_BINDING),
    OPALINE_STATE(GL_ELEMENT_ARRAY_BUFFER_BINDING),
    OPALINE_STATE(GL_COPY_READ_BUFFER_BINDING),
    OPALINE_STATE(GL_COPY_WRITE_BUFFER_BINDING),
    OPALINE_STATE(GL_PIXEL_PACK_BUFFER_BINDING),
    OPALINE_STATE(GL_PIXEL_UNPACK_BUFFER_BINDING),
    OPALINE_STATE(GL_SHADER_STORAGE_BUFFER_BINDING),
    OPALINE_STATE(GL_UNIFORM_BUFFER_BINDING),
    OPALINE_STATE(GL_ATOMIC_COUNTER_BUFFER_BINDING),
    OPALINE_STATE(GL_DISPATCH_INDIRECT_BUFFER_BINDING),
    OPALINE_STATE(GL_DRAW_INDIRECT_BUFFER_BINDING),
    OPALINE_STATE(GL_TRANSFORM_FEEDBACK_BUFFER_BINDING),
    OPALINE_STATE(GL_UNPACK_ALIGNMENT),
    OPALINE_STATE(GL_UNPACK_ROW_LENGTH),
    OPALINE_STATE(GL_UNPACK_SKIP_ROWS),
    OPALINE_STATE(GL_UNPACK_SKIP_PIXELS),
    OPALINE_STATE(GL_UNPACK_SKIP_IMAGES),
    OPALINE_STATE(GL_UNPACK_IMAGE_HEIGHT),
    OPALINE_DESKTOP_STATE(GL_UNPACK_SWAP_BYTES),
    OPALINE_DESKTOP_STATE(GL_UNPACK_LSB_FIRST),
    OPALINE_STATE(GL_PACK_ALIGNMENT),
    OPALINE_STATE(GL_PACK_ROW_LENGTH),
    OPALINE_STATE(GL_BLEND),
    OPALINE_STATE(GL_CULL_FACE),
    OPALINE_STATE(GL_DEPTH_TEST),
    OPALINE_STATE(GL_DITHER),
    OPALINE_STATE(GL_POLYGON_OFFSET_FILL),
    OPALINE_STATE(GL_PRIMITIVE_RESTART_FIXED_INDEX),
    OPALINE_STATE(GL_RASTERIZER_DISCARD),
    OPALINE_STATE(GL_SAMPLE_ALPHA_TO_COVERAGE),
    OPALINE_STATE(GL_SAMPLE_COVERAGE),
    OPALINE_STATE(GL_SAMPLE_MASK),
    OPALINE_STATE(GL_SCISSOR_TEST),
    OPALINE_STATE(GL_STENCIL_TEST),
    OPALINE_DESKTOP_STATE(GL_FRAMEBUFFER_SRGB),
    OPALINE_DESKTOP_STATE(GL_PROGRAM_POINT_SIZE),
    OPALINE_STATE(GL_DEPTH_FUNC),
    OPALINE_STATE(GL_DEPTH_WRITEMASK),
    OPALINE_STATE(GL_CULL_FACE_MODE),
    OPALINE_STATE(GL_VIEWPORT),
};

using State = std::map<std::string, std::int64_t>;

State query_state(bool is_es) {
    State state;
    for (const StateName& s : kStates) {
        if (is_es && !s.is_in_es) continue;
        std::array<GLint, 4> value{};
        glGetIntegerv(s.name, value.data());
        for (std::size_t i = 0; i < value.size(); ++i) {
            state[std::string(s.text) + " " + std::to_string(i)] = value[i];
        }
    }
    for (GLuint i = 0; i < kBlocks; ++i) {
        for (const GLenum target : {GL_SHADER_STORAGE_BUFFER_BINDING, GL_UNIFORM_BUFFER_BINDING}) {
            const std::string name = "block " + std::to_string(target) + " " + std::to_string(i);
            const bool is_storage = target == GL_SHADER_STORAGE_BUFFER_BINDING;
            GLint buffer = 0;
            GLint64 start = 0, size = 0;
            glGetIntegeri_v(target, i, &buffer);
            glGetInteger64i_v(is_storage ? GL_SHADER_STORAGE_BUFFER_START : GL_UNIFORM_BUFFER_START,
                              i, &start);
            glGetInteger64i_v(is_storage ? GL_SHADER_STORAGE_BUFFER_SIZE : GL_UNIFORM_BUFFER_SIZE,
                              i, &size);
            state[name + " buffer"] = buffer;
            state[name + " start"] = start;
            state[name + " size"] = size;
        }
    }
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        for (const GLenum target :
             {GL_TEXTURE_BINDING_2D, GL_TEXTURE_BINDING_2D_ARRAY, GL_TEXTURE_BINDING_3D,
              GL_TEXTURE_BINDING_CUBE_MAP, GL_SAMPLER_BINDING}) {
            GLint texture = 0;
            glGetIntegerv(target, &texture);
            state["unit " + std::to_string(unit) + " " + std::to_string(target)] = texture;
        }
    }
    glActiveTexture(static_cast<GLenum>(active));
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    return state;
}

GLuint make_host_program(bool is_es) {
    const GLuint program = glCreateProgram(), shader = glCreateShader(GL_COMPUTE_SHADER);
    const char* const text[] = {is_es ? "#version 310 es\n" : "#version 430 core\n",
                                "layout(local_size_x = 1) in; void main() {}"};
    glShaderSource(shader, 2, text, nullptr);
    glCompileShader(shader);
    glAttachShader(program, shader);
    glLinkProgram(program);
    return program;
}

// As unlike the defaults as a host in the middle of a frame; the objects live as long as the
// context.
void set_host_state(bool is_es) {
    std::array<GLuint, 12> buffer{};
    glGenBuffers(static_cast<GLsizei>(buffer.size()), buffer.data());
    for (const GLuint name : buffer) {
        glBindBuffer(GL_ARRAY_BUFFER, name);
        glBufferData(GL_ARRAY_BUFFER, 4096, nullptr, GL_STATIC_DRAW);
    }
    std::array<GLuint, 2 * kUnits> texture{};
    glGenTextures(static_cast<GLsizei>(texture.size()), texture.data());
    GLuint array = 0, framebuffer = 0;
    glGenVertexArrays(1, &array);
    glBindVertexArray(array);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer[0]);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer[1]);
    glBindBuffer(GL_COPY_WRITE_BUFFER, buffer[2]);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, buffer[3]);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, buffer[4]);
    // A whole buffer, parts of them, and none.
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffer[5]);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 1, buffer[6], 256, 512);
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 3, buffer[6], 1024, 64);
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 5, buffer[7]);
    glBindBufferRange(GL_UNIFORM_BUFFER, 1, buffer[8], 256, 512);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer[9]);
    glBindBuffer(GL_COPY_READ_BUFFER, buffer[10]);
    for (GLuint unit = 0; unit < kUnits; ++unit) {
        glActiveTexture(GL_TEXTURE0 + unit);
        glBindTexture(GL_TEXTURE_2D, texture[2 * unit]);
        glBindTexture(GL_TEXTURE_2D_ARRAY, texture[2 * unit + 1]);
    }
    glActiveTexture(GL_TEXTURE2);
    glUseProgram(make_host_program(is_es));
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 77);
    glPixelStorei(GL_UNPACK_SKIP_ROWS, 3);
    glPixelStorei(GL_UNPACK_SKIP_PIXELS, 5);
    glPixelStorei(GL_UNPACK_SKIP_IMAGES, 2);
    glPixelStorei(GL_UNPACK_IMAGE_HEIGHT, 33);
    glPixelStorei(GL_PACK_ROW_LENGTH, 55);
    if (!is_es) glPixelStorei(GL_UNPACK_SWAP_BYTES, 1);
    for (const GLenum switched : {GL_BLEND, GL_CULL_FACE, GL_DEPTH_TEST, GL_SCISSOR_TEST,
                                  GL_STENCIL_TEST, GL_RASTERIZER_DISCARD}) {
        glEnable(switched);
    }
    glDisable(GL_DITHER);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_FALSE);
    glViewport(3, 4, 50, 60);
}

class EmbedGlState : public EmbedGl {};

TEST_P(EmbedGlState, IsAsBeforeAfterEveryCall) {
    const bool is_es = GetParam() == HostApi::es_31;
    formats::Asset asset = make_every_kind(8, 8);
    add_primitive(asset, make_sphere({-4, 0, 0}, 1, 50, 40), {.details = 5});  // a row of texels
    asset.images.push_back(make_noise_image(7, 5));  // rows that are no whole words
    asset.volumes = make_volumes(8);
    TestVolume fog;
    fog.extent = {3, 3, 3};
    fog.spacing = 1;  // more nodes than a row of texels holds
    fog.single_terms = 1;
    add_volume(asset.volumes, fog);
    TestLayer layer = even_test_layer();
    layer.flux = {8, 6};
    layer.radiance = {4, 4, 2};
    asset.clouds = make_test_clouds(layer);
    host_ = std::make_unique<EmbeddedAsset>(asset);
    set_host_state(is_es);
    const State before = query_state(is_es);
    constexpr std::uint32_t kAll = OPALINE_GL_WITH_MESH | OPALINE_GL_WITH_TEXTURE |
                                   OPALINE_GL_WITH_VOLUMES | OPALINE_GL_WITH_IMAGES;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, kAll, &gl_), OPALINE_OK)
        << opaline_last_error();
    EXPECT_EQ(query_state(is_es), before) << "create";
    opaline_volume_light* volume_light = nullptr;
    ASSERT_EQ(opaline_volume_light_create(host_->asset(), &volume_light), OPALINE_OK);
    opaline_layer_light* layer_light = nullptr;
    ASSERT_EQ(opaline_layer_light_create(host_->asset(), &layer_light), OPALINE_OK);
    const auto objects = filled<opaline_gl_objects>(opaline_gl_get_objects, gl_);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(opaline_gl_relight(gl_, host_->light()), OPALINE_OK) << opaline_last_error();
        EXPECT_EQ(query_state(is_es), before) << "relight";
        const float eye[3] = {1, 2, 9};
        EXPECT_EQ(opaline_gl_look_from(gl_, eye), OPALINE_OK) << opaline_last_error();
        EXPECT_EQ(query_state(is_es), before) << "look_from";
        ASSERT_EQ(opaline_volume_light_update(volume_light, host_->asset(), host_->light(), 0, 1),
                  OPALINE_OK);
        EXPECT_EQ(opaline_gl_light_volumes(gl_, volume_light), OPALINE_OK) << opaline_last_error();
        EXPECT_EQ(query_state(is_es), before) << "light_volumes";
        EXPECT_EQ(opaline_gl_show_layer(gl_, host_->asset(), layer_light), OPALINE_OK)
            << opaline_last_error();
        EXPECT_EQ(query_state(is_es), before) << "show_layer";
    }
    // What the host had in its hands did not change what was computed.
    expect_same_receivers(host_->expected(std::array<float, 3>{1, 2, 9}.data()),
                          read_floats(objects.radiance, 4 * std::size_t{host_->receivers()}));
    opaline_volume_light_release(volume_light);
    opaline_layer_light_release(layer_light);
    EXPECT_EQ(opaline_gl_release(std::exchange(gl_, nullptr)), OPALINE_OK);
    EXPECT_EQ(query_state(is_es), before) << "release";
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlState, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
