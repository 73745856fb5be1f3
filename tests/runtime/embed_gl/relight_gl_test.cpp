// Values that Opaline::gl hands out: those of opaline_shade_from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

#include "tests/formats/opal/slot_fixture.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#define GL_GLEXT_PROTOTYPES
#include <GL/glcorearb.h>

namespace opaline::test {
namespace {

opaline_gl_objects objects_of(const opaline_gl* gl) {
    return filled<opaline_gl_objects>(opaline_gl_get_objects, gl);
}

class EmbedGlRelight : public EmbedGl {
  protected:
    std::vector<float> radiance() const {
        return read_floats(objects_of(gl_).radiance, 4 * std::size_t{host_->receivers()});
    }
    void expect_relit(const float* eye = nullptr) const {
        expect_same_receivers(host_->expected(eye), radiance());
    }
};

// What the other cases mean by these names.
TEST_P(EmbedGlRelight, ContextsOfMesaAreTheOldestThatAreTaken) {
    const std::string version = reinterpret_cast<const char*>(glGetString(GL_VERSION));
    if (version.find("Mesa") == std::string::npos) GTEST_SKIP() << version;
    EXPECT_EQ(version.rfind(GetParam() == HostApi::es_31 ? "OpenGL ES 3.1" : "4.3", 0), 0u)
        << version;
}

TEST_P(EmbedGlRelight, RadianceIsThatOfTheCpuForEveryKindOfReceiver) {
    for (const std::uint32_t code_bits : {8u, 16u}) {
        make(make_every_kind(8, code_bits));
        EXPECT_THAT(radiance(), testing::Each(0));
        relight();
        expect_relit();
        const float eye[3] = {2, 1, 7}, off[3] = {0, 0, 0}, tinted[3] = {3, 1, 0.25f};
        look_from({2, 1, 7});
        expect_relit(eye);
        opaline_light_set_emitter(host_->light(), 0, off);
        opaline_light_set_emitter(host_->light(), 1, tinted);
        relight();
        expect_relit(eye);
        opaline_light_set_emitter(host_->light(), 1, off);
        relight();
        expect_relit(eye);
        EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
    }
}

// Every corner of a triangle has a copy of its vertex.
TEST_P(EmbedGlRelight, VerticesThatShareRowsShowWhatTheCpuSays) {
    const formats::Asset asset = tests::with_copied_corners(make_every_kind(8, 8));
    ASSERT_FALSE(asset.slots.empty());
    make(asset, OPALINE_GL_WITH_TEXTURE);
    relight();
    expect_relit();
    const float eye[3] = {2, 1, 7}, tinted[3] = {3, 1, 0.25f};
    look_from({2, 1, 7});
    expect_relit(eye);
    opaline_light_set_emitter(host_->light(), 1, tinted);
    relight();
    expect_relit(eye);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_P(EmbedGlRelight, VerticesWithoutRowsOfTheirOwnShowWhatTheCpuSays) {
    const formats::Asset asset = tests::with_mixed_vertices(make_every_kind(8, 8));
    ASSERT_TRUE(
        std::ranges::any_of(asset.slots.mix, [](const auto& mix) { return !mix.is_one(); }));
    make(asset, OPALINE_GL_WITH_TEXTURE);
    relight();
    expect_relit();
    const float eye[3] = {2, 1, 7}, tinted[3] = {3, 1, 0.25f};
    opaline_light_set_emitter(host_->light(), 1, tinted);
    look_from({2, 1, 7});
    relight();
    expect_relit(eye);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_P(EmbedGlRelight, CopiesShowWhatTheCpuSays) {
    const formats::Asset asset =
        tests::with_two_copies(tests::with_mixed_vertices(make_every_kind(8, 8)));
    make(asset, OPALINE_GL_WITH_TEXTURE);
    relight();
    expect_relit();
    const float eye[3] = {2, 1, 7};
    look_from({2, 1, 7});
    expect_relit(eye);
    EXPECT_EQ(glGetError(), GLenum{GL_NO_ERROR});
}

TEST_P(EmbedGlRelight, IndicesOfFourBytesAreRead) {
    formats::Asset asset = make_asset(128, 8);
    add_primitive(asset, make_sphere({0, 0, 0}, 1, 5, 4), {.bands = 1, .details = 90});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 5, 4), {.bands = 3, .details = 90});
    ASSERT_EQ(asset.view().transport.index_bytes, 4u);
    make(asset);
    relight();
    expect_relit();
}

TEST_P(EmbedGlRelight, EyeSetBeforeTheFirstRelightCounts) {
    make(make_every_kind(8, 8));
    const float eye[3] = {-4, 1, -2};
    look_from({-4, 1, -2});
    relight();
    expect_relit(eye);
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

TEST_P(EmbedGlRelight, TextureHoldsWhatTheBufferDoes) {
    formats::Asset asset = make_every_kind(8, 8);
    add_primitive(asset, make_sphere({-4, 0, 0}, 1, 50, 40), {.details = 5});
    make(asset, OPALINE_GL_WITH_TEXTURE);
    ASSERT_GT(host_->receivers(), 2048u);  // rows of the texture, and a part of one
    const auto texels = [&] { return read_texture(objects_of(gl_), host_->receivers()); };
    EXPECT_THAT(texels(), testing::Each(0));
    relight();
    const float eye[3] = {2, 1, 7};
    look_from({2, 1, 7});
    EXPECT_EQ(texels(), radiance());
    expect_relit(eye);
}

TEST_P(EmbedGlRelight, MeshIsThatOfTheAsset) {
    const formats::Asset asset = make_every_kind(8, 8);
    make(asset, OPALINE_GL_WITH_MESH);
    const opaline_gl_objects objects = objects_of(gl_);
    const std::size_t vertices = asset.position.size();
    const auto same = [](const std::vector<float>& read, const auto& expected) {
        return std::memcmp(read.data(), expected.data(), read.size() * sizeof(float)) == 0;
    };
    EXPECT_TRUE(same(read_floats(objects.position, 3 * vertices), asset.position));
    EXPECT_TRUE(same(read_floats(objects.normal, 3 * vertices), asset.normal));
    EXPECT_TRUE(same(read_floats(objects.base_color, 3 * vertices), asset.base_color));
    EXPECT_TRUE(same(read_floats(objects.texcoord, 2 * vertices), asset.texcoord));
    EXPECT_TRUE(same(read_floats(objects.triangle, asset.index.size()), asset.index));
    EXPECT_EQ(objects.openness + objects.radiance_texture, 0u);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlRelight, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
