// What is installed for hosts that draw the images of surfaces, beside the CPU's samples.
#include <gtest/gtest.h>

#include "formats/opal/openness.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/runtime/embed_gl/gl_fixture.h"

namespace opaline::test {
namespace {

constexpr formats::Wrap kWraps[] = {formats::Wrap::repeat, formats::Wrap::clamp,
                                    formats::Wrap::mirror};

// Of each primitive another way to wrap; a mask, a blend and a whole surface.
formats::Asset make_pictured() {
    formats::Asset asset = make_asset(8, 8);
    asset.images.push_back(make_noise_image(13, 9));
    asset.images.push_back(make_noise_image(7, 5));
    asset.gloss.resize(3);
    for (std::uint32_t p = 0; p < 3; ++p) {
        add_primitive(asset, make_sphere({3.0f * static_cast<float>(p), 0, 0}, 1, 5, 4),
                      {.image = 0, .wrap_u = kWraps[p], .wrap_v = kWraps[(p + 1) % 3]});
        formats::GlossRecord& gloss = asset.gloss[p];
        gloss.roughness = 0.5f;
        gloss.f0 = {0.04f, 0.04f, 0.04f};
        gloss.image = 1;
        gloss.wrap_u = nearest(kWraps[(p + 2) % 3]);
        gloss.wrap_v = nearest(kWraps[p]);
        if (p == 2) continue;
        formats::HoleRecord hole;
        hole.primitive = p;
        hole.alpha = 0.8f;
        hole.cutoff = 0.45f;
        hole.image = 1;
        hole.mode = p == 0 ? formats::HoleMode::mask : formats::HoleMode::blend;
        asset.holes.record.push_back(hole);
    }
    asset.roughness.assign(asset.primitives.size(), formats::kNotGlossy);
    asset.openness.assign(asset.position.size(), formats::encode_openness({0, 1, 0}, 1));
    asset.holes.vertex_alpha.assign(asset.position.size(), 0.5f);
    return asset;
}

class EmbedGlImages : public EmbedGl {};

opaline_gl_images images_of(const opaline_gl* gl, std::uint32_t primitive) {
    return filled<opaline_gl_images>(opaline_gl_get_images, gl, primitive);
}

TEST_P(EmbedGlImages, SamplesAndCoverageAreTheCpus) {
    make(make_pictured(), OPALINE_GL_WITH_IMAGES);
    parity::Report report;
    parity::compare_images({*host_, GetParam(), gl_, report});
    EXPECT_TRUE(report.holds()) << report.text("images", "");
}

TEST_P(EmbedGlImages, PrimitivesSayWhatTheyTakeAndWrongUseIsTold) {
    make(make_pictured(), OPALINE_GL_WITH_IMAGES);
    opaline_gl* without = nullptr;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &without), OPALINE_OK);
    const opaline_gl_images masked = images_of(gl_, 0), whole = images_of(gl_, 2);
    EXPECT_NE(masked.alpha.texture, 0u);
    EXPECT_EQ(masked.alpha.texture, masked.gloss.texture);  // the file has it once
    EXPECT_EQ(masked.cutoff_mode[1], 1.0f);
    EXPECT_EQ(masked.alpha_factor, 0.8f);
    EXPECT_EQ(masked.emission.texture, 0u);
    EXPECT_EQ(read_floats(masked.vertex_alpha, 3), std::vector<float>(3, 0.5f));
    EXPECT_EQ(images_of(gl_, 1).cutoff_mode[1], 2.0f);
    EXPECT_EQ(whole.cutoff_mode[1], 0.0f);
    EXPECT_EQ(whole.alpha_factor, 1.0f);
    EXPECT_EQ(whole.alpha.texture + whole.vertex_alpha, 0u);
    const opaline_gl_images none = images_of(without, 0);
    EXPECT_EQ(none.base_color.texture + none.srgb_table + none.alpha.texture, 0u);
    opaline_gl_images images{};
    EXPECT_EQ(opaline_gl_get_images(gl_, 0, &images), OPALINE_INVALID_ARGUMENT);
    images.struct_size = sizeof images;
    EXPECT_THAT((Statuses{opaline_gl_get_images(gl_, 3, &images),
                          opaline_gl_get_images(nullptr, 0, &images),
                          opaline_gl_get_images(gl_, 0, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlImages, kBothContexts, api_name);

}  // namespace
}  // namespace opaline::test
