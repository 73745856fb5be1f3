#include "runtime/shade.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/texture.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/row_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;

/// A grey primitive and a textured RGB one of random rows, and one vertex of neither.
Asset make_flat_asset(std::uint32_t n) {
    Asset asset;
    asset.transport = tests::random_rows(n, 8, 1, 11);
    PrimitiveRecord grey;
    grey.vertex_count = asset.transport.view().rows();
    PrimitiveRecord rgb = grey;
    rgb.bands = 3;
    rgb.first_vertex = grey.vertex_count;
    rgb.first_row = grey.vertex_count;
    rgb.first_band_row = grey.vertex_count;
    rgb.first_code = asset.transport.code8.size();
    rgb.base_color_image = 0;
    formats::append_rows(asset.transport, tests::random_rows(n, 8, 3, 12));
    asset.primitives = {grey, rgb};
    const std::size_t vertices = 2 * std::size_t{grey.vertex_count} + 1;
    asset.position.resize(vertices);
    asset.normal.resize(vertices, {0, 1, 0});
    asset.base_color.resize(vertices, {0.5f, 0.25f, 1});
    for (std::size_t v = 0; v < vertices; ++v) {
        asset.texcoord.push_back({0.01f * static_cast<float>(v), 0.3f});
    }
    asset.images.push_back({2, 2, {10, 20, 30, 200, 100, 50, 255, 255, 255, 0, 128, 0}});
    return asset;
}

TEST(Shade, RadianceIsBaseColourTimesTheDotProductAndNotBelowZero) {
    const Asset asset = make_flat_asset(8);
    const formats::AssetView view = asset.view();
    const LightVector light = tests::random_light(8, 13);
    std::vector<Rgb> out(view.receivers()), white(view.receivers());
    shade(view, light, out);
    shade(view, light, white, {.base_color = false});
    std::size_t black = 0;
    for (const PrimitiveRecord& p : view.primitives) {
        std::vector<Rgb> sum(p.vertex_count);
        dot_rows(view.transport, p.rows(), light, 0, sum, best_dot_path());
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

TEST(Shade, ThreadsAndRangesDoNotChangeABit) {
    const Asset asset = make_flat_asset(8);
    const formats::AssetView view = asset.view();
    const LightVector light = tests::random_light(8, 14);
    std::vector<Rgb> one(view.receivers());
    shade(view, light, one, {.threads = 1});
    for (const unsigned threads : {2u, 5u}) {
        std::vector<Rgb> many(view.receivers());
        shade(view, light, many, {.threads = threads});
        EXPECT_EQ(many, one);
    }
    for (std::uint32_t first = 0; first < one.size(); first += 17) {
        std::vector<Rgb> part(std::min<std::size_t>(30, one.size() - first));
        shade_range(view, light, first, part);
        EXPECT_TRUE(std::equal(part.begin(), part.end(), one.begin() + first)) << first;
    }
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
    std::vector<Rgb> out(1);
    shade(asset.view(), white, out);
    // The plane meets texel borders, so only 16-bit quantisation is left.
    EXPECT_NEAR(out[0].r, 0.8f, 1e-4f);
    EXPECT_NEAR(out[0].b, 0.2f, 1e-4f);
}

TEST(Shade, OverflowingSumsAreShownAsFiniteNumbers) {
    Asset asset = make_flat_asset(8);
    for (float& scale : asset.transport.detail_scale) {
        scale = std::numeric_limits<float>::max();
    }
    std::vector<Rgb> out(asset.position.size());
    shade(asset.view(), tests::random_light(8, 15), out);
    for (const Rgb c : out) {
        EXPECT_TRUE(std::isfinite(c.r) && std::isfinite(c.g) && std::isfinite(c.b));
    }
}

}  // namespace
}  // namespace opaline::runtime
