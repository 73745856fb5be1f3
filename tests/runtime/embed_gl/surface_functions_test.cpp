// The functions that are installed for hosts' shaders, in shaders of a host: what each receiver
// sends to the eye, one texel each, beside opaline_shade_from.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "formats/opal/openness.h"
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

}  // namespace
}  // namespace opaline::test
