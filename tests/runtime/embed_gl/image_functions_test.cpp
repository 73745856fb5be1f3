// What is installed for hosts that draw the images of surfaces, beside the CPU's samples.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "formats/opal/openness.h"
#include "runtime/holes.h"
#include "runtime/texture.h"
#include "tests/runtime/embed_gl/embedded_asset.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/embed_gl/host/host_images.h"

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
    const formats::Asset asset = make_pictured();
    const EmbeddedAsset host(asset);
    opaline_gl* gl = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_IMAGES, &gl), OPALINE_OK)
        << opaline_last_error();
    std::mt19937 generator(11);
    std::uniform_real_distribution<float> value(-3, 3), share(0, 1);
    std::vector<HostRay> samples;
    for (int i = 0; i < 500; ++i) {
        samples.push_back({{value(generator), value(generator), 0},
                           share(generator),
                           {static_cast<float>(i % 97), static_cast<float>(i % 31), 0},
                           0});
    }
    samples.push_back({{NAN, INFINITY, 0}, 0.45f, {0, 0, 0}, 0});
    for (std::uint32_t p = 0; p < 3; ++p) {
        SCOPED_TRACE(p);
        const opaline_gl_images images = images_of(gl, p);
        HostPicture picture =
            make_image_picture(GetParam(), images.base_color, images.gloss, images);
        const std::vector<float> drawn = picture.draw(samples);
        const formats::AssetView view = asset.view();
        int covered = 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const formats::Float2 uv{samples[i].from[0], samples[i].from[1]};
            const formats::Rgb color =
                runtime::sample_image_linear(view.images[0], uv, kWraps[p], kWraps[(p + 1) % 3]);
            const formats::Rgb factors = runtime::sample_image_values(
                view.images[1], uv, nearest(kWraps[(p + 2) % 3]), nearest(kWraps[p]));
            EXPECT_NEAR(drawn[8 * i], color.r, 1e-5f) << i;
            EXPECT_NEAR(drawn[8 * i + 2], color.b, 1e-5f) << i;
            EXPECT_NEAR(drawn[8 * i + 5], factors.g, 1e-5f) << i;
            if (p == 2) continue;
            const bool sees =
                runtime::sees_surface(view.holes.record[p], samples[i].begin,
                                      {static_cast<std::uint32_t>(samples[i].direction[0]),
                                       static_cast<std::uint32_t>(samples[i].direction[1]), 17});
            EXPECT_EQ(drawn[8 * i + 3] == 1, sees) << i;
            covered += sees ? 1 : 0;
        }
        if (p < 2) {
            EXPECT_GT(covered, 150);
            EXPECT_LT(covered, 400);
        }
    }
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
}

TEST_P(EmbedGlImages, PrimitivesSayWhatTheyTakeAndWrongUseIsTold) {
    const EmbeddedAsset host(make_pictured());
    opaline_gl *gl = nullptr, *without = nullptr;
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, OPALINE_GL_WITH_IMAGES, &gl), OPALINE_OK);
    ASSERT_EQ(opaline_gl_create(host.asset(), load_gl, 0, &without), OPALINE_OK);
    const opaline_gl_images masked = images_of(gl, 0), whole = images_of(gl, 2);
    EXPECT_NE(masked.alpha.texture, 0u);
    EXPECT_EQ(masked.alpha.texture, masked.gloss.texture);  // the file has it once
    EXPECT_EQ(masked.cutoff_mode[1], 1.0f);
    EXPECT_EQ(masked.alpha_factor, 0.8f);
    EXPECT_EQ(masked.emission.texture, 0u);
    EXPECT_EQ(read_floats(masked.vertex_alpha, 3), std::vector<float>(3, 0.5f));
    EXPECT_EQ(images_of(gl, 1).cutoff_mode[1], 2.0f);
    EXPECT_EQ(whole.cutoff_mode[1], 0.0f);
    EXPECT_EQ(whole.alpha_factor, 1.0f);
    EXPECT_EQ(whole.alpha.texture + whole.vertex_alpha, 0u);
    const opaline_gl_images none = images_of(without, 0);
    EXPECT_EQ(none.base_color.texture + none.srgb_table + none.alpha.texture, 0u);
    opaline_gl_images images{};
    EXPECT_EQ(opaline_gl_get_images(gl, 0, &images), OPALINE_INVALID_ARGUMENT);
    images.struct_size = sizeof images;
    EXPECT_EQ(opaline_gl_get_images(gl, 3, &images), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_images(nullptr, 0, &images), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_get_images(gl, 0, nullptr), OPALINE_INVALID_ARGUMENT);
    EXPECT_EQ(opaline_gl_release(gl), OPALINE_OK);
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlImages, testing::Values(HostApi::desktop_43, HostApi::es_31),
                         api_name);

}  // namespace
}  // namespace opaline::test
