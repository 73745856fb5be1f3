// Light of emitters: rows beside those of the environment.
#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/emitter_light.h"
#include "runtime/shade.h"
#include "runtime/texture.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"
#include "tests/support/float_traps.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;

/// A grey primitive and a textured RGB one of random rows, and one vertex of neither.
Asset make_flat_asset(std::uint32_t n) {
    Asset asset;
    asset.transport = formats::make_sparse_rows(n, 8);
    tests::add_random_primitive(asset, n, {}, 11);
    PrimitiveRecord rgb;
    rgb.bands = 3;
    rgb.base_color_image = 0;
    tests::add_random_primitive(asset, n, rgb, 12);
    asset.position.emplace_back();
    asset.normal.push_back({0, 1, 0});
    asset.base_color.push_back({0.5f, 0.25f, 1});
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        asset.texcoord.push_back({0.01f * static_cast<float>(v), 0.3f});
    }
    asset.images.push_back({2, 2, {10, 20, 30, 200, 100, 50, 255, 255, 255, 0, 128, 0}});
    return asset;
}

TEST(Shade, RadianceIsBaseColourTimesTheDotProductAndNotBelowZero) {
    const Asset asset = make_flat_asset(8);
    const formats::AssetView view = asset.view();
    const LightVector light = tests::random_light(8, 13);
    const auto out = tests::shaded(asset, light),
               white = tests::shaded(asset, light, {.base_color = false});
    std::size_t black = 0;
    for (const PrimitiveRecord& p : view.primitives) {
        std::vector<Rgb> sum(p.vertex_count);
        dot_rows(view.transport, p.rows(p.vertex_count), light, 0, sum, best_dot_path());
        for (std::uint32_t i = 0; i < p.vertex_count; ++i) {
            const Rgb color = vertex_base_color(view, p, p.first_vertex + i);
            const float expected = std::max(0.0f, sum[i].g * color.g);
            EXPECT_FLOAT_EQ(out[p.first_vertex + i].g, expected);
            EXPECT_FLOAT_EQ(white[p.first_vertex + i].b, std::max(0.0f, sum[i].b));
            black += expected == 0.0f ? 1 : 0;
        }
    }
    EXPECT_GT(black, 0u);  // random rows: the clamp was at work
    EXPECT_EQ(out.back(), Rgb{});
}

// An unoccluded diffuse receiver under a white sky has its albedo as radiance. All coefficients
// kept, 16-bit codes; transport values are texel means by exact first moments.
TEST(Shade, WhiteFurnaceGivesTheAlbedo) {
    const std::uint32_t n = 32;
    const std::vector<formats::Vec3> moment = formats::texel_moments(n);
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    std::vector<float> row(moment.size());
    const formats::Vec3 normal{0, 1, 0};
    for (std::size_t j = 0; j < row.size(); ++j) {
        row[j] = static_cast<float>(std::max(0.0f, dot(moment[j], normal)) /
                                    (std::numbers::pi * solid_angle[j % (n * n)]));
    }
    formats::haar_forward_cube(std::span<float>(row), n);
    formats::SparseRow sparse;
    for (std::uint32_t k = 0; k < row.size(); ++k) {
        if (k % (n * n) == 0) {
            sparse.average.push_back(row[k]);
        } else if (row[k] != 0.0f) {
            sparse.index.push_back(k);
            sparse.value.push_back(row[k]);
        }
    }
    Asset asset;
    asset.transport = formats::make_sparse_rows(n, 16);
    formats::append_row(asset.transport, sparse);
    PrimitiveRecord p;
    p.vertex_count = 1;
    asset.primitives = {p};
    asset.position.resize(1);
    asset.normal = {normal};
    asset.base_color = {{0.8f, 0.5f, 0.2f}};
    const LightVector white = project_environment(tests::lat_long_map(64, 32,
                                                                      [](formats::Vec3) {
                                                                          return Rgb{1, 1, 1};
                                                                      }),
                                                  n);
    const std::vector<Rgb> out = tests::shaded(asset, white);
    // The plane meets texel borders, so only 16-bit quantisation is left.
    EXPECT_NEAR(out[0].r, 0.8f, 1e-4f);
    EXPECT_NEAR(out[0].b, 0.2f, 1e-4f);
}

TEST(Shade, OverflowingSumsAreShownAsFiniteNumbers) {
    const opaline::tests::UntrappedFloats untrapped;  // what is given overflows
    Asset asset = make_flat_asset(8);
    for (float& scale : asset.transport.detail_scale) {
        scale = std::numeric_limits<float>::max();
    }
    tests::expect_finite(tests::shaded(asset, tests::random_light(8, 15)));
}

// Opaque, thin-walled and translucent primitives.
Asset emitting_asset() {
    Asset asset = tests::make_small_asset();
    tests::add_sheet_triangle(asset);
    tests::add_translucent_triangle(asset, 4, 1.3f);
    tests::add_emitters(asset);
    return asset;
}

LightVector black_light() {
    return {8, std::vector<float>(4 * 384)};
}

std::vector<Rgb> shaded(const Asset& asset, const LightVector& light, const EmitterLight& emitters,
                        std::optional<formats::Vec3> eye = std::nullopt) {
    ShadeOptions options;
    options.emitters = emitters;
    options.eye = eye;
    return tests::shaded(asset, light, options);
}

TEST(EmitterLight, OpaqueSurfacesShowItTimesTheirBaseColourAndTheirOwn) {
    const Asset asset = emitting_asset();
    const formats::AssetView view = asset.view();
    const std::vector<Rgb> out = shaded(asset, black_light(), {});
    for (std::uint32_t v = 0; v < 4; ++v) {
        const Rgb value = block_value(view.emitters, view.emitters.block[0], v);
        const Rgb own =
            Rgb{100, 50, 25} * sample_image_linear(view.images[0], asset.texcoord[v],
                                                   formats::Wrap::mirror, formats::Wrap::clamp);
        EXPECT_NEAR(out[v].r, 0.5f * value.r + own.r, 1e-3f);
        EXPECT_NEAR(out[v].g, 0.6f * value.g + own.g, 1e-3f);
    }
    const std::vector<Rgb> without = shaded(asset, black_light(), {{}, false});
    const Rgb value = block_value(view.emitters, view.emitters.block[0], 3);
    EXPECT_NEAR(without[3].b, 0.7f * value.b, 1e-4f);
}

TEST(EmitterLight, ThinWallsShowTheSideThatIsSeen) {
    const Asset asset = emitting_asset();
    const formats::AssetView view = asset.view();
    const auto blocks = view.emitters.blocks_of(2);
    ASSERT_EQ(blocks.size(), 1u);
    const auto front = shaded(asset, black_light(), {}, formats::Vec3{0, 0, 5});
    const auto behind = shaded(asset, black_light(), {}, formats::Vec3{0, 0, -5});
    EXPECT_NEAR(front[9].g, block_value(view.emitters, blocks[0], 2).g, 1e-3f);
    EXPECT_NEAR(behind[9].g, block_value(view.emitters, blocks[0], 3).g, 1e-3f);
}

// What a renderer interpolates has no light of the surface itself.
TEST(EmitterLight, PicturesAddTheirOwnLightPerPixel) {
    const Asset asset = emitting_asset();
    const auto with =
        shade_for_picture(asset.view(), black_light(), {0, 0, 5}, formats::TermSet::all, 1);
    const Rgb value = block_value(asset.emitters.view(), asset.emitters.block[0], 1);
    EXPECT_NEAR(with[1].r, value.r, 1e-3f);
}

}  // namespace

}  // namespace opaline::runtime
