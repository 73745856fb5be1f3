#include "bake/encode/shorten_rows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "bake/encode/select_coefficients.h"
#include "formats/opal/cubemap.h"
#include "tests/formats/opal/asset_fixture.h"

namespace opaline::bake {
namespace {

std::vector<float> decode_bands(const formats::SparseRowsView& rows,
                                const formats::PrimitiveRecord& primitive, std::uint32_t row) {
    const std::size_t size = formats::cubemap_texels(rows.cubemap_size);
    std::vector<float> bands(primitive.bands * size);
    for (std::uint32_t band = 0; band < primitive.bands; ++band) {
        formats::decode_row(rows, primitive.rows(primitive.vertex_count), row, band,
                            std::span(bands).subspan(band * size, size));
    }
    return bands;
}

TEST(ShortenRows, KeepTheCodesOfTheCoefficientsThatABakeWouldKeep) {
    constexpr std::uint32_t kKept = 26;
    for (const std::uint32_t bits : {8u, 16u}) {
        const formats::Asset asset = tests::make_small_asset(bits);
        const formats::AssetView full = asset.view();
        const auto made = shorten_rows(full, kKept);
        ASSERT_TRUE(made);
        const formats::AssetView view = made->view_of(full);
        const std::size_t size = formats::cubemap_texels(full.cubemap_size);
        for (std::size_t p = 0; p < full.primitives.size(); ++p) {
            const std::uint32_t bands = full.primitives[p].bands;
            for (std::uint32_t row = 0; row < full.rows_of(p).rows; ++row) {
                std::vector<float> expected = decode_bands(full.transport, full.primitives[p], row);
                const formats::SparseRow best =
                    select_coefficients(make_selector(full.cubemap_size, kKept), expected, bands);
                ASSERT_EQ(best.index.size(), kKept - 6);
                for (std::size_t k = 0; k < size; ++k) {
                    const bool is_average = k % (size / 6) == 0;
                    const bool is_kept = std::ranges::binary_search(best.index, k);
                    for (std::uint32_t band = 0; band < bands && !is_average && !is_kept; ++band) {
                        expected[band * size + k] = 0;
                    }
                }
                ASSERT_EQ(decode_bands(view.transport, view.primitives[p], row), expected);
            }
        }
        EXPECT_EQ(longest_row(view), kKept);
    }
}

TEST(ShortenRows, StayAsTheyAreWhereAllCoefficientsAreKept) {
    const formats::Asset asset = tests::make_small_asset();
    const auto made = shorten_rows(asset.view(), longest_row(asset.view()));
    ASSERT_TRUE(made);
    EXPECT_EQ(made->rows.index16, asset.transport.index16);
    EXPECT_EQ(made->rows.code8, asset.transport.code8);
    EXPECT_EQ(made->rows.average_code, asset.transport.average_code);
}

TEST(ShortenRows, ThatPrimitivesShareAreRefused) {
    formats::Asset asset = tests::make_small_asset();
    asset.primitives.push_back(asset.primitives.back());
    EXPECT_FALSE(shorten_rows(asset.view(), 10));
}

}  // namespace
}  // namespace opaline::bake
