// Vertices of one place and one normal that share rows show what vertices with rows of their own
// do.
#include <gtest/gtest.h>

#include "tests/formats/opal/slot_fixture.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;
using formats::Shading;

/// One primitive of every shading, lit by emitters too, with triangles between any of its vertices.
Asset make_asset_of_all_shadings() {
    Asset asset;
    const auto add = [&](Shading shading, std::uint32_t terms, std::uint32_t bands,
                         std::uint32_t flags) {
        PrimitiveRecord record;
        record.shading = shading;
        record.terms = terms;
        record.bands = bands;
        record.flags = flags;
        record.eta = shading == Shading::translucent ? 1.4f : 0;
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.index_count = 300;
        // More than a block of rows.
        tests::add_random_primitive(asset, 8, record, 20 + terms, terms == 1 ? 14 : 7);
        const std::uint32_t count = asset.primitives.back().vertex_count;
        for (std::uint32_t i = 0; i < record.index_count; ++i) {
            asset.index.push_back(i * i % count);
        }
    };
    add(Shading::diffuse, 1, 1, 0);
    add(Shading::translucent, 5, 3, PrimitiveRecord::kSeparate);
    add(Shading::sheet, 2, 3, 0);
    add(Shading::translucent, 9, 3, PrimitiveRecord::kDoubleSided);
    add(Shading::diffuse, 1, 3, PrimitiveRecord::kDoubleSided);
    tests::add_emitters(asset);
    return asset;
}

TEST(SharedRows, EveryCopyOfAVertexShowsWhatTheVertexShowsBitForBit) {
    const Asset asset = make_asset_of_all_shadings();
    std::vector<std::uint32_t> from;
    const Asset copied = tests::with_copied_corners(asset, &from);
    ASSERT_GT(copied.position.size(), asset.position.size() + 1000);
    const LightVector light = tests::random_light(8, 5);
    for (const auto& eye :
         {std::optional<formats::Vec3>(), std::optional(formats::Vec3{1, 2, 3})}) {
        for (const bool fresnel : {true, false}) {
            const ShadeOptions options{.eye = eye, .fresnel = fresnel};
            const std::vector<Rgb> own = tests::shaded(asset, light, options),
                                   shared = tests::shaded(copied, light, options);
            for (std::size_t v = 0; v < from.size(); ++v) {
                ASSERT_EQ(shared[v], own[from[v]]) << v;
            }
            tests::expect_same_in_threads_and_ranges(copied, light, options);
            // Vertices that share rows with those before the range.
            for (std::uint32_t first = 1; first < from.size(); first += 101) {
                std::vector<Rgb> rest(from.size() - first);
                shade_range(copied.view(), light, first, rest, options);
                ASSERT_TRUE(std::equal(rest.begin(), rest.end(), shared.begin() + first)) << first;
            }
        }
    }
}

TEST(SharedRows, BaseColourIsEachVertexsOwn) {
    Asset asset = tests::with_copied_corners(make_asset_of_all_shadings());
    const LightVector light = tests::random_light(8, 6);
    const std::vector<Rgb> white = tests::shaded(asset, light, {.base_color = false});
    for (std::size_t v = 0; v < asset.position.size(); ++v) {
        asset.base_color[v] = {v % 2 == 0 ? 0.5f : 0.25f, 1, 0};
    }
    const std::vector<Rgb> colored = tests::shaded(asset, light);
    // The first primitive has own light, which has no base colour.
    for (std::size_t v = asset.primitives[1].first_vertex; v < asset.position.size(); ++v) {
        ASSERT_FLOAT_EQ(colored[v].r, (v % 2 == 0 ? 0.5f : 0.25f) * white[v].r) << v;
        ASSERT_EQ(colored[v].b, 0) << v;
    }
}

}  // namespace
}  // namespace opaline::runtime
