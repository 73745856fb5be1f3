// Vertices without rows of their own show the weighted mean of what others do.
#include <gtest/gtest.h>

#include "tests/formats/opal/opal_bytes.h"
#include "tests/formats/opal/slot_fixture.h"
#include "tests/runtime/light_test_support.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::PrimitiveRecord;
using formats::Rgb;
using formats::Shading;

Asset make_asset_with_triangles() {
    Asset asset;
    for (const Shading shading : {Shading::diffuse, Shading::sheet, Shading::diffuse}) {
        PrimitiveRecord record;
        record.shading = shading;
        record.terms = shading == Shading::sheet ? 2 : 1;
        record.bands = asset.primitives.empty() ? 1 : 3;
        record.first_index = static_cast<std::uint32_t>(asset.index.size());
        record.index_count = 1500;
        tests::add_random_primitive(asset, 8, record, 40, 10);
        const std::uint32_t count = asset.primitives.back().vertex_count;
        for (std::uint32_t i = 0; i < record.index_count; ++i) {
            asset.index.push_back(i * i % count);
        }
    }
    tests::add_emitters(asset);
    return asset;
}

TEST(MixedRows, AVertexShowsTheMeanOfItsSlotsByWeight) {
    const Asset asset = tests::with_mixed_vertices(make_asset_with_triangles());
    const LightVector light = tests::random_light(8, 5);
    // What a renderer interpolates: without base colour and own light.
    const ShadeOptions options{.base_color = false, .fresnel = false};
    const std::vector<Rgb> shown = tests::shaded(asset, light, options);
    std::size_t mixed = 0;
    for (std::uint32_t v = 0; v < shown.size(); ++v) {
        if (!asset.slots.view().is_mixed(v)) continue;
        ++mixed;
        const formats::SlotMix& mix = asset.slots.mix[v];
        double mean = 0, most = 1e-3;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto of_slot = static_cast<double>(shown[asset.slots.vertex[mix.slot[k]]].g);
            mean += mix.weight[k] / 255.0 * std::max(0.0, of_slot);
            most = std::max(most, of_slot);
        }
        ASSERT_NEAR(static_cast<double>(shown[v].g), mean, 1e-5 * most) << v;
    }
    EXPECT_EQ(mixed, 1000u);
    tests::expect_same_in_threads_and_ranges(asset, light, options);
    tests::expect_same_in_threads_and_ranges(asset, light, {});
    // Vertices that are mixed of others outside the range.
    const std::uint32_t first = asset.primitives[2].first_vertex + 700;
    std::vector<Rgb> part(50);
    shade_range(asset.view(), light, first, part, options);
    EXPECT_TRUE(std::equal(part.begin(), part.end(), shown.begin() + first));
}

// Their light comes from the rows of the original, whatever their place.
TEST(MixedRows, CopiesShowWhatTheirOriginalShows) {
    Asset dark = tests::with_mixed_vertices(make_asset_with_triangles());
    dark.emitters = {};
    const tests::StoredAsset stored(tests::with_two_copies(dark));
    const formats::AssetView& asset = stored.view();
    std::vector<Rgb> shown(asset.receivers());
    shade(asset, tests::random_light(8, 5), shown, {.base_color = false, .fresnel = false});
    const std::size_t primitives = asset.primitives.size();
    const formats::PrimitiveRecord& original = asset.primitives[0];
    const auto shown_by = [&](const formats::PrimitiveRecord& p) {
        return std::span(shown).subspan(p.first_vertex, p.vertex_count);
    };
    ASSERT_GT(original.vertex_count, 0u);
    for (const std::size_t copy : {primitives - 2, primitives - 1}) {
        EXPECT_TRUE(std::ranges::equal(shown_by(asset.primitives[copy]), shown_by(original)));
    }
}

}  // namespace
}  // namespace opaline::runtime
