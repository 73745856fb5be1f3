#include "runtime/gloss.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/surface.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Environment;
using formats::GlossRecord;
using formats::Rgb;
using formats::TermSet;
using formats::Vec3;

formats::GlossSurface metal(Rgb color, float roughness) {
    return formats::make_gloss_surface({}, color, 1, roughness);
}

TEST(GlossLight, CellsCoverTheSphereOnceWithAllTheLight) {
    const Environment sky = tests::lat_long_map(128, 64, tests::smooth_sky);
    const GlossLight light = make_gloss_light(sky, 0);
    const GlossLight::Cells& cells = light.cells;
    EXPECT_LE(cells.size(), kLightCells);
    EXPECT_GT(cells.size(), kLightCells - 16);
    EXPECT_EQ(cells.size() % kCellBlock, 0u);
    double solid_angle = 0, flux = 0, coarsest = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
        solid_angle += cells.solid_angle[i];
        flux += cells.g[i];
        EXPECT_NEAR(std::hypot(cells.x[i], cells.y[i], cells.z[i]), 1, 1e-5f);
    }
    for (const Rgb c : light.map.back().pixel) {
        coarsest += c.g * 4 * std::numbers::pi / 6;
    }
    EXPECT_NEAR(solid_angle, 4 * std::numbers::pi, 1e-4);
    EXPECT_NEAR(flux, coarsest, 1e-4 * coarsest);
    EXPECT_EQ(light.map.size(), 8u);
    EXPECT_EQ(light.map.back().width, 1u);
}

// Of both kinds of glossy surfaces.
TEST(SpecularLight, HasTheSameBitsForAnyNumberOfThreads) {
    const Environment sky = tests::lat_long_map(64, 32, tests::smooth_sky);
    const SpecularLight one = make_specular_light(sky, {{8, 40}, true}, {}, 1),
                        three = make_specular_light(sky, {{8, 40}, true}, {}, 3);
    ASSERT_EQ(one.maps.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(one.maps[i].radiance.pixel, three.maps[i].radiance.pixel);
    }
    for (std::size_t i = 0; i < one.gloss.map.size(); ++i) {
        EXPECT_EQ(one.gloss.map[i].pixel, three.gloss.map[i].pixel);
    }
    EXPECT_EQ(one.gloss.cells.x, three.gloss.cells.x);
    EXPECT_EQ(one.gloss.cells.r, three.gloss.cells.r);
}

TEST(GlossLight, SmallDiscsAreSunsAndLargeOnesLight) {
    Environment environment;
    environment.discs = {{{0, 1, 0}, 0.005f, {100, 100, 100}}, {{1, 0, 0}, 0.3f, {2, 2, 2}}};
    const GlossLight light = make_gloss_light(environment, 1);
    ASSERT_EQ(light.suns.size(), 1u);
    EXPECT_EQ(light.suns[0].angular_radius, 0.005f);
    double flux = 0;
    for (const float g : light.cells.g) {
        flux += g;
    }
    EXPECT_NEAR(flux, 2 * formats::disc_solid_angle(0.3f), 1e-3);
}

TEST(Gloss, WhiteLightComesOutAsTheAlbedoAtEveryRoughness) {
    const GlossLight light = make_gloss_light(tests::even_sky({1, 1, 1}), 1);
    for (const float roughness : {0.0f, 0.1f, 0.3f, 0.45f, 0.7f, 1.0f}) {
        for (const float c : {0.01f, 0.1f, 0.5f, 1.0f}) {
            const formats::GlossSurface surface = metal({1, 0.5f, 0.1f}, roughness);
            const Rgb found = eval_gloss(light, {}, surface, tests::seen_at(c));
            const Rgb expected = formats::eval_gloss_albedo(surface, c).specular;
            EXPECT_NEAR(found.r, expected.r, 1e-5f) << roughness << ' ' << c;
            EXPECT_NEAR(found.r, 1, 1e-5f);
            EXPECT_NEAR(found.b, expected.b, 1e-5f);
        }
    }
}

TEST(Gloss, AMirrorShowsTheLightWhereTheLawOfReflectionSaysAndTurnsWithIt) {
    const Vec3 toward = normalize(Vec3{-0.6f, 0.8f, 0});
    const Environment spot = tests::lat_long_map(256, 128, [&](Vec3 d) {
        const float on = dot(d, toward) > 0.99f ? 1.0f : 0.0f;
        return Rgb{on, on, on};
    });
    const GlossLight light = make_gloss_light(spot, 1);
    for (const float turn : {0.0f, 0.9f}) {
        const Rotation rotation = rotation_about_y(turn);
        const Vec3 lit = rotation.world_from_light({0.6f, 0.8f, 0});
        const Vec3 aside = rotation.world_from_light({-0.6f, 0.8f, 0});
        const formats::GlossSurface mirror = metal({1, 1, 1}, 0.05f);
        EXPECT_NEAR(eval_gloss(light, rotation, mirror, {{0, 1, 0}, lit, 0.8f, false}).r, 1, 0.02f);
        EXPECT_LT(eval_gloss(light, rotation, mirror, {{0, 1, 0}, aside, 0.8f, false}).r, 0.01f);
    }
}

TEST(Gloss, AMirrorShowsTheSunsOwnRadiance) {
    Environment environment;
    environment.discs = {{{0, 1, 0}, 0.005f, {300, 200, 100}}};
    const GlossLight light = make_gloss_light(environment, 1);
    const Rgb found = eval_gloss(light, {}, metal({1, 1, 1}, 0), tests::seen_at(1));
    // Widened, with the mirror's own width on top.
    const float expected = 300 * 0.0025f * 0.0025f / (0.0025f * 0.0025f + 1e-6f);
    EXPECT_NEAR(found.r, expected, 0.02f * expected);
    EXPECT_NEAR(found.b, found.r / 3, 0.01f * found.r);
}

TEST(Gloss, FadesBehindTheSilhouetteAndIsBlackWithoutANormalOrLight) {
    const GlossLight light = make_gloss_light(tests::even_sky({1, 1, 1}), 1);
    const formats::GlossSurface surface = metal({1, 1, 1}, 0.5f);
    const auto at = [&](float c) { return eval_gloss(light, {}, surface, tests::seen_at(c)).r; };
    EXPECT_NEAR(at(0), 1, 1e-4f);
    EXPECT_NEAR(at(-0.1f), 0.5f, 1e-4f);
    EXPECT_EQ(at(-0.2f), 0);
    EXPECT_EQ(eval_gloss(light, {}, surface, {{0, 0, 0}, {0, 1, 0}, 0, false}), Rgb{});
    EXPECT_EQ(eval_gloss({}, {}, surface, tests::seen_at(0.5f)), Rgb{});
}

TEST(Gloss, StaysFiniteUnderAbsurdLight) {
    const float largest = std::numeric_limits<float>::max();
    Environment environment = tests::even_sky({largest, 0, 1e-38f});
    environment.discs = {{{0, 1, 0}, 0.1f, {largest, largest, 0}},
                         {{0, 1, 0}, 0.001f, {largest, largest, 0}}};
    const GlossLight light = make_gloss_light(environment, 1);
    for (const float roughness : {0.0f, 0.45f, 1.0f}) {
        for (const float c : {0.001f, 0.5f, 1.0f}) {
            const Rgb found = eval_gloss(light, {}, metal({1, 1, 1}, roughness), tests::seen_at(c));
            EXPECT_TRUE(std::isfinite(found.r) && std::isfinite(found.g) && std::isfinite(found.b));
            EXPECT_GE(found.b, 0);
        }
    }
}

// A metal, a dielectric with an image of roughness, and a diffuse primitive.
Asset make_glossy_asset(float open = 1) {
    Asset asset;
    asset.images.push_back({2, 1, {0, 255, 255, 0, 102, 51}});
    for (std::uint32_t p = 0; p < 3; ++p) {
        formats::PrimitiveRecord record;
        record.bands = 3;
        tests::add_random_primitive(asset, 8, record, 31 + p);
        GlossRecord gloss;
        gloss.metallic = p == 0 ? 1.0f : 0.5f;
        gloss.roughness = p == 2 ? formats::kNotGlossy : 0.5f;
        gloss.f0 = {0.04f, 0.04f, 0.04f};
        gloss.image = p == 1 ? 0 : formats::kNoImage;
        asset.gloss.push_back(gloss);
        asset.roughness.push_back(formats::kNotGlossy);
    }
    for (const Vec3 normal : asset.normal) {
        asset.texcoord.push_back({0.75f, 0.5f});  // the centre of the right texel
        asset.openness.push_back(formats::encode_openness(normal, open));
    }
    return asset;
}

class GlossShade : public testing::Test {
  protected:
    std::vector<Rgb> shaded(const Asset& asset, const ShadeOptions& options) {
        return tests::shaded(asset, light_, options);
    }
    Environment sky_ = tests::lat_long_map(64, 32, tests::smooth_sky);
    LightVector light_ = project_environment(sky_, 8);
    SpecularLight specular_ = make_specular_light(sky_, {{}, true}, {}, 1);
    Vec3 eye_{0, 0.5f, 5};
};

TEST_F(GlossShade, AnAssetSaysWhatItNeeds) {
    const Asset asset = make_glossy_asset();
    EXPECT_TRUE(specular_needs(asset.view()).gloss);
    EXPECT_TRUE(specular_needs(asset.view()).levels.empty());
    Asset matt = make_glossy_asset();
    for (GlossRecord& gloss : matt.gloss) {
        gloss.roughness = formats::kNotGlossy;
    }
    EXPECT_FALSE(specular_needs(matt.view()).any());
}

TEST_F(GlossShade, EveryVertexFollowsTheModel) {
    const Asset asset = make_glossy_asset();
    const auto found = shaded(asset, {.eye = eye_, .specular = &specular_});
    const auto rows = shaded(asset, {.base_color = false, .eye = eye_, .fresnel = false});
    std::size_t lit = 0;
    for (std::size_t v = 0; v < found.size(); ++v) {
        const formats::PrimitiveRecord& p =
            formats::primitive_of(asset.view(), static_cast<std::uint32_t>(v));
        const auto number = static_cast<std::size_t>(&p - asset.view().primitives.data());
        const Rgb diffuse = rows[v] * asset.base_color[v];
        if (number == 2) {
            EXPECT_EQ(found[v], diffuse);
            continue;
        }
        const ViewOfReceiver view = view_receiver(p, asset.position[v], asset.normal[v], eye_);
        // The image's right texel is (0, 102, 51): roughness times 0.4, metallic times 0.2.
        const GlossRecord& gloss = asset.gloss[number];
        const formats::GlossSurface surface = formats::make_gloss_surface(
            gloss, asset.base_color[v], gloss.metallic * (number == 1 ? 0.2f : 1.0f),
            gloss.roughness * (number == 1 ? 0.4f : 1.0f));
        const float share =
            formats::eval_gloss_albedo(surface, std::max(std::abs(view.cosine), 1e-3f)).diffuse;
        const Rgb expected =
            share * diffuse + eval_gloss(specular_.gloss, specular_.rotation, surface, view);
        EXPECT_NEAR(found[v].g, expected.g, 1e-5f * (1 + expected.g)) << v;
        EXPECT_NEAR(found[v].b, expected.b, 1e-5f * (1 + expected.b)) << v;
        lit += found[v].g > 0 ? 1u : 0u;
    }
    EXPECT_GT(lit, 10u);
}

TEST_F(GlossShade, ComponentsAddUpAndOpennessTakesTheSpecularOne) {
    const Asset asset = make_glossy_asset();
    const auto whole = shaded(asset, {.eye = eye_, .specular = &specular_});
    const auto diffuse =
        shaded(asset, {.eye = eye_, .terms = TermSet::diffuse, .specular = &specular_});
    const auto specular =
        shaded(asset, {.eye = eye_, .terms = TermSet::specular, .specular = &specular_});
    EXPECT_EQ(shaded(asset, {.eye = eye_}), diffuse);
    std::size_t glossy = 0;
    for (std::size_t v = 0; v < whole.size(); ++v) {
        EXPECT_NEAR(whole[v].g, diffuse[v].g + specular[v].g, 1e-5f * (1 + whole[v].g));
        glossy += specular[v].g > 0 ? 1u : 0u;
    }
    EXPECT_GT(glossy, 10u);
    // Nothing of the sky; metals mirror the surfaces that close them in, whose light is their row.
    const Asset closed = make_glossy_asset(0);
    for (const Rgb c :
         shaded(closed, {.eye = eye_, .terms = TermSet::specular, .specular = &specular_})) {
        EXPECT_EQ(c, Rgb{});
    }
    const auto enclosed = shaded(closed, {.eye = eye_, .specular = &specular_});
    const auto rows = shaded(closed, {.eye = eye_});
    std::size_t mirroring = 0;
    for (std::uint32_t p = 0; p < closed.primitives.size(); ++p) {
        const formats::PrimitiveRecord& record = closed.primitives[p];
        const GlossRecord& gloss = closed.gloss[p];
        const bool is_metal = gloss.metallic == 1 && gloss.image == formats::kNoImage;
        for (std::uint32_t v = record.first_vertex; v < record.first_vertex + record.vertex_count;
             ++v) {
            EXPECT_EQ(is_metal ? rows[v] : enclosed[v], is_metal ? Rgb{} : rows[v]) << v;
            mirroring += is_metal && enclosed[v].g > 0 ? 1u : 0u;
        }
    }
    EXPECT_GT(mirroring, 0u);
}

}  // namespace
}  // namespace opaline::runtime
