// The functions that are installed for hosts' shaders, in shaders of a host: what each receiver
// sends to the eye, one texel each, beside opaline_shade_from.
// What is installed for hosts that draw the images of surfaces, beside the CPU's samples.
// What is installed for hosts that draw normal maps, beside the CPU's normals and light.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/opal/openness.h"
#include "formats/opal/sheet_shares.h"
#include "tests/bench/gl_parity/comparisons.h"
#include "tests/runtime/embed_gl/gl_fixture.h"
#include "tests/runtime/embed_gl/host/host_surface.h"

namespace opaline::test {
namespace {

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
    make(make_glossy_ones(), OPALINE_GL_WITH_MESH);
    // The light as it is; turned, which leaves maps of what is mirrored as they are; another one.
    for (int step = 0; step < 3; ++step) {
        const float turned[9] = {0, 0, -1, 0.6f, 0.8f, 0, 0.8f, -0.6f, 0}, sky[3] = {2, 3, 4};
        if (step == 1) {
            ASSERT_EQ(opaline_light_set_rotation(host_->light(), turned), OPALINE_OK);
        } else if (step == 2) {
            ASSERT_EQ(opaline_light_set_lat_long(host_->light(), sky, 1, 1), OPALINE_OK);
        }
        const formats::Vec3 eye = step == 1 ? formats::Vec3{2, 1, 7} : formats::Vec3{-3, 4, -5};
        look_from(eye);
        relight();
        std::vector<float> cpu(3 * std::size_t{host_->receivers()});
        ASSERT_EQ(opaline_shade_from(host_->asset(), host_->light(), 0, &eye.x, 0,
                                     host_->receivers(), cpu.data(), cpu.size()),
                  OPALINE_OK);
        expect_same_receivers(cpu, draw_receivers(host_->asset(), gl_, GetParam(), &eye.x));
    }
    opaline_gl_surface surface{};
    surface.struct_size = sizeof surface;
    EXPECT_THAT((Statuses{opaline_gl_get_surface(gl_, 8, &surface),
                          opaline_gl_get_surface(nullptr, 0, &surface),
                          opaline_gl_get_surface(gl_, 0, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    surface.struct_size = 3;
    EXPECT_EQ(opaline_gl_get_surface(gl_, 0, &surface), OPALINE_INVALID_ARGUMENT);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlSurface, kBothContexts, api_name);

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

using formats::Asset;
using formats::Vec3;

class EmbedGlNormalMaps : public EmbedGl {};

constexpr formats::SheetShares kShares{{0.5f, 0.25f, 0.75f}, {0.25f, 0.5f, 0}};

Asset make_mapped() {
    Asset asset = make_asset(16, 8);
    asset.images.push_back(make_noise_image(7, 5));
    add_primitive(asset, make_sphere({}, 1, 5, 4), {});
    add_primitive(asset, make_sphere({3, 0, 0}, 1, 5, 4), {.eta = 1.3f});
    add_primitive(asset, make_sphere({6, 0, 0}, 1, 5, 4), {});
    add_normal_map(asset,
                   {.primitive = 0, .image = 0, .wrap_v = formats::Wrap::mirror, .scale = 0.7f},
                   {1, 0, 0}, -1);
    add_normal_map(asset, {.primitive = 1, .image = 0}, {1, 0, 0}, 1);
    add_primitive(asset, make_sheet({9, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2, 1), {.is_sheet = true});
    formats::NormalMapRecord map{.primitive = 3, .image = 0};
    formats::store_sheet_shares(kShares, map);
    add_normal_map(asset, map, {1, 0, 0}, 1);
    return asset;
}

opaline_gl_normal_map normal_map_of(const opaline_gl* gl, std::uint32_t primitive) {
    return filled<opaline_gl_normal_map>(opaline_gl_get_normal_map, gl, primitive);
}

TEST_P(EmbedGlNormalMaps, NormalsAndTurnedLightAreTheCpus) {
    make(make_mapped(), OPALINE_GL_WITH_IMAGES);
    EXPECT_EQ(normal_map_of(gl_, 0).harmonics[0][0], 0);
    const float sky[9][3] = {{2, 2, 3}, {1, 0.9f, 0.5f}, {0.2f, 0.1f, 0}};
    const float toward[3] = {0.3f, 0.8f, 0.5f}, radiance[3] = {9000, 8000, 7000};
    ASSERT_EQ(opaline_light_clear(host_->light()), OPALINE_OK);
    ASSERT_EQ(opaline_light_set_harmonics(host_->light(), &sky[0][0]), OPALINE_OK);
    ASSERT_EQ(opaline_light_add_sun(host_->light(), toward, 0.01f, radiance), OPALINE_OK);
    relight();
    const opaline_gl_normal_map map = normal_map_of(gl_, 0);
    ASSERT_GE(map.suns, 1);
    EXPECT_EQ(map.is_turned, 1u);
    EXPECT_EQ(map.scale, 0.7f);
    EXPECT_EQ(normal_map_of(gl_, 3).is_turned, 2u);
    // The light that these numbers should be of.
    const Vec3 sun{map.sun_direction[0][0], map.sun_direction[0][1], map.sun_direction[0][2]};
    EXPECT_GT(dot(sun, formats::normalize({0.3f, 0.8f, 0.5f})), 0.999f);
    EXPECT_NEAR(map.harmonics[0][2] / map.harmonics[0][0], 1.5f, 0.05f);
    parity::Report report;
    parity::compare_normal_maps({*host_, GetParam(), gl_, report});
    EXPECT_TRUE(report.holds()) << report.text("normal maps", "");
}

TEST_P(EmbedGlNormalMaps, PrimitivesSayWhatTheyHaveAndWrongUseIsTold) {
    make(make_mapped(), OPALINE_GL_WITH_IMAGES);
    opaline_gl* without = nullptr;
    ASSERT_EQ(opaline_gl_create(host_->asset(), load_gl, 0, &without), OPALINE_OK);
    EXPECT_EQ(normal_map_of(gl_, 0).image.wrap[1], 2);
    EXPECT_NE(normal_map_of(gl_, 0).tangent, 0u);
    EXPECT_EQ(normal_map_of(gl_, 1).is_turned, 0u);  // translucent
    EXPECT_NE(normal_map_of(gl_, 1).image.texture, 0u);
    EXPECT_EQ(normal_map_of(gl_, 2).image.texture, 0u);
    EXPECT_EQ(normal_map_of(without, 0).image.texture, 0u);
    opaline_gl_normal_map map{};
    EXPECT_EQ(opaline_gl_get_normal_map(gl_, 0, &map), OPALINE_INVALID_ARGUMENT);
    map.struct_size = sizeof map;
    EXPECT_THAT((Statuses{opaline_gl_get_normal_map(gl_, 4, &map),
                          opaline_gl_get_normal_map(nullptr, 0, &map),
                          opaline_gl_get_normal_map(gl_, 0, nullptr)}),
                testing::Each(OPALINE_INVALID_ARGUMENT));
    EXPECT_EQ(opaline_gl_release(without), OPALINE_OK);
}

INSTANTIATE_TEST_SUITE_P(On, EmbedGlNormalMaps, kBothContexts, api_name);

}  // namespace

}  // namespace opaline::test
