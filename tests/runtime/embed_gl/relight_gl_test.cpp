// Values that Opaline::gl hands out: those of opaline_shade_from.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

opaline_gl_objects objects_of(const opaline_gl* gl) {
    opaline_gl_objects objects{};
    objects.struct_size = sizeof objects;
    EXPECT_EQ(opaline_gl_get_objects(gl, &objects), OPALINE_OK);
    return objects;
}

// To 1e-5 of the brightest receiver: sums of some hundred floats in another order.
void expect_relit(const EmbeddedAsset& host, const std::vector<float>& gl, const float* eye) {
    const std::vector<float> cpu = host.expected(eye);
    ASSERT_EQ(gl.size() / 4, cpu.size() / 3);
    const float brightest = *std::max_element(cpu.begin(), cpu.end());
    ASSERT_GT(brightest, 0.1f);
    float largest = 0;
    for (std::size_t i = 0; i < cpu.size(); ++i) {
        const float difference = std::abs(cpu[i] - gl[i / 3 * 4 + i % 3]);
        EXPECT_LE(difference, 1e-5f * brightest) << "receiver " << i / 3;
        largest = std::max(largest, difference);
    }
    std::cout << "[ agreement] " << largest / brightest << "\n";
}

// What the other cases mean by these names.
TEST_P(EmbedGl, ContextsOfMesaAreTheOldestThatAreTaken) {
    const std::string version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    if (version.find("Mesa") == std::string::npos) GTEST_SKIP() << version;
    EXPECT_EQ(version.rfind(GetParam() == HostApi::es_31 ? "OpenGL ES 3.1" : "4.3", 0), 0u)
        << version;
}

TEST_P(EmbedGl, RadianceIsThatOfTheCpuForEveryKindOfReceiver) {
    for (const std::uint32_t code_bits : {8u, 16u}) {
        const EmbeddedAsset host(make_every_kind(8, code_bits));
        opaline_gl* gl = nullptr;
        ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, 0, &gl), OPALINE_OK)
            << opaline_last_error();
        const unsigned radiance = objects_of(gl).radiance;
        const std::size_t floats = 4 * std::size_t{host.receivers()};
        EXPECT_EQ(read_floats(radiance, floats), std::vector<float>(floats));

        ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK) << opaline_last_error();
        expect_relit(host, read_floats(radiance, floats), nullptr);
        const float eye[3] = {2, 1, 7}, off[3] = {0, 0, 0}, tinted[3] = {3, 1, 0.25f};
        ASSERT_EQ(opaline_gl_look_from(gl, eye), OPALINE_OK);
        expect_relit(host, read_floats(radiance, floats), eye);
        opaline_light_set_emitter(host.light(), 0, off);
        opaline_light_set_emitter(host.light(), 1, tinted);
        ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK);
        expect_relit(host, read_floats(radiance, floats), eye);
        opaline_light_set_emitter(host.light(), 1, off);
        ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK);
        expect_relit(host, read_floats(radiance, floats), eye);
        EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
}

TEST_P(EmbedGl, IndicesOfFourBytesAreRead) {
    formats::Asset asset = make_asset(128, 8);
    add_primitive(asset, make_sphere({0, 0, 0}, 1, 5, 4), {.bands = 1, .details = 90});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 5, 4), {.bands = 3, .details = 90});
    ASSERT_EQ(asset.view().transport.index_bytes, 4u);
    const EmbeddedAsset host(asset);
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, 0, &gl), OPALINE_OK);
    ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK);
    expect_relit(host, read_floats(objects_of(gl).radiance, 4 * std::size_t{host.receivers()}),
                 nullptr);
    opaline_gl_release(gl);
}

TEST_P(EmbedGl, EyeSetBeforeTheFirstRelightCounts) {
    const EmbeddedAsset host(make_every_kind(8, 8));
    const float eye[3] = {-4, 1, -2};
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, 0, &gl), OPALINE_OK);
    ASSERT_EQ(opaline_gl_look_from(gl, eye), OPALINE_OK);
    ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK);
    expect_relit(host, read_floats(objects_of(gl).radiance, 4 * std::size_t{host.receivers()}),
                 eye);
    opaline_gl_release(gl);
}

// Read as a vertex shader would, through a framebuffer here.
std::vector<float> read_texture(const opaline_gl_objects& objects, std::uint32_t receivers) {
    const auto width = static_cast<GLsizei>(objects.radiance_texture_width);
    const auto rows = static_cast<GLsizei>(receivers / objects.radiance_texture_width + 1);
    std::vector<float> texels(std::size_t{4} * objects.radiance_texture_width *
                              static_cast<std::size_t>(rows));
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D,
                           objects.radiance_texture, 0);
    EXPECT_EQ(glCheckFramebufferStatus(GL_READ_FRAMEBUFFER), GLenum{GL_FRAMEBUFFER_COMPLETE});
    glReadPixels(0, 0, width, rows, GL_RGBA, GL_FLOAT, texels.data());
    glDeleteFramebuffers(1, &framebuffer);
    texels.resize(4 * std::size_t{receivers});
    return texels;
}

TEST_P(EmbedGl, TextureHoldsWhatTheBufferDoes) {
    formats::Asset asset = make_every_kind(8, 8);
    add_primitive(asset, make_sphere({-4, 0, 0}, 1, 50, 40), {.details = 5});
    const EmbeddedAsset host(asset);
    ASSERT_GT(host.receivers(), 2048u);  // rows of the texture, and a part of one
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_TEXTURE, &gl), OPALINE_OK)
        << opaline_last_error();
    const opaline_gl_objects objects = objects_of(gl);
    const std::size_t floats = 4 * std::size_t{host.receivers()};
    EXPECT_EQ(read_texture(objects, host.receivers()), std::vector<float>(floats));
    ASSERT_EQ(opaline_gl_relight(gl, host.light()), OPALINE_OK) << opaline_last_error();
    const float eye[3] = {2, 1, 7};
    ASSERT_EQ(opaline_gl_look_from(gl, eye), OPALINE_OK);
    EXPECT_EQ(read_texture(objects, host.receivers()), read_floats(objects.radiance, floats));
    expect_relit(host, read_texture(objects, host.receivers()), eye);
    opaline_gl_release(gl);
}

TEST_P(EmbedGl, MeshIsThatOfTheAsset) {
    const formats::Asset asset = make_every_kind(8, 8);
    const EmbeddedAsset host(asset);
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_MESH, &gl), OPALINE_OK);
    const opaline_gl_objects objects = objects_of(gl);
    const std::size_t vertices = asset.position.size();
    const auto same = [](const std::vector<float>& read, const auto& expected) {
        return std::memcmp(read.data(), expected.data(), read.size() * sizeof(float)) == 0;
    };
    EXPECT_TRUE(same(read_floats(objects.position, 3 * vertices), asset.position));
    EXPECT_TRUE(same(read_floats(objects.normal, 3 * vertices), asset.normal));
    EXPECT_TRUE(same(read_floats(objects.base_color, 3 * vertices), asset.base_color));
    EXPECT_TRUE(same(read_floats(objects.texcoord, 2 * vertices), asset.texcoord));
    EXPECT_TRUE(same(read_floats(objects.triangle, asset.index.size()), asset.index));
    EXPECT_EQ(objects.openness, 0u);
    EXPECT_EQ(objects.radiance_texture, 0u);
    opaline_gl_release(gl);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGl, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
