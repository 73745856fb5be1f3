#include "runtime/embed_gl/dot_batches.h"
#include "runtime/embed_gl/spread_batches.h"

#include <gtest/gtest.h>

#include "tests/formats/opal/slot_fixture.h"
#include "tests/runtime/picture/synthetic_asset.h"

namespace opaline::runtime {
namespace {

formats::Asset two_primitives(std::uint32_t code_bits) {
    formats::Asset asset = test::make_asset(8, code_bits);
    test::add_primitive(asset, test::make_sphere({0, 0, 0}, 1, 7, 5), {.bands = 1, .details = 37});
    test::add_primitive(asset, test::make_sphere({2, 0, 0}, 1, 6, 4), {.bands = 3, .details = 50});
    return asset;
}

TEST(DotBatches, CoverEveryVertexOnceWithinTheLimits) {
    for (const std::uint32_t code_bits : {8u, 16u}) {
        const formats::Asset asset = two_primitives(code_bits);
        for (const DotLimits limits : {DotLimits{1 << 20, 256, 1000}, DotLimits{1 << 20, 4, 5},
                                       DotLimits{600, 32, 1000}, DotLimits{1500, 256, 3}}) {
            const auto batches = plan_dot_batches(asset.view(), limits);
            ASSERT_TRUE(batches.has_value());
            std::uint32_t next = 0;
            for (const DotBatch& batch : *batches) {
                EXPECT_EQ(batch.first_slot, next);
                EXPECT_GT(batch.slots, 0u);
                EXPECT_LE(batch.slots, limits.max_vertices);
                next += batch.slots;
                for (const BoundRange& range : {batch.transport, batch.radiance}) {
                    EXPECT_EQ(range.offset % limits.alignment, 0u);
                    EXPECT_EQ(range.size % 4, 0u);
                    EXPECT_LE(range.size, limits.max_block_bytes);
                }
            }
            EXPECT_EQ(next, asset.position.size());
        }
    }
}

TEST(DotBatches, OfTranslucentPrimitivesBindEveryRowsResult) {
    formats::Asset asset = two_primitives(8);
    test::add_primitive(asset, test::make_sphere({4, 0, 0}, 1, 6, 4),
                        {.bands = 3, .details = 20, .eta = 1.3f, .terms = 9});
    const formats::PrimitiveRecord& p = asset.primitives[2];
    for (const DotLimits limits :
         {DotLimits{1 << 20, 256, 1000}, DotLimits{1 << 20, 4, 20}, DotLimits{2000, 32, 1000}}) {
        const auto batches = plan_dot_batches(asset.view(), limits);
        ASSERT_TRUE(batches.has_value());
        std::uint32_t next = p.first_vertex;
        for (const DotBatch& batch : *batches) {
            if (batch.primitive != 2) {
                EXPECT_EQ(batch.product.size, 0u);
                continue;
            }
            EXPECT_EQ(batch.first_slot, next);
            next += batch.slots;
            EXPECT_LE(batch.slots * batch.terms, limits.max_vertices);
            const std::uint32_t first = batch.first_slot - p.first_vertex;
            EXPECT_EQ(batch.product.offset + 16 * batch.product.origin,
                      16 * (p.first_row + first * std::size_t{9}));
            EXPECT_EQ(batch.point.offset + 4 * batch.point.origin,
                      12 * std::size_t{batch.first_slot});
            for (const BoundRange& range : {batch.product, batch.point}) {
                EXPECT_EQ(range.offset % limits.alignment, 0u);
                EXPECT_LE(range.size, limits.max_block_bytes);
            }
            EXPECT_GE(batch.product.size, 16 * (batch.product.origin + batch.slots * 9u));
            EXPECT_GE(batch.point.size, 4 * (batch.point.origin + batch.slots * 3u));
        }
        EXPECT_EQ(next, asset.position.size());
    }
}

TEST(SpreadBatches, GiveEveryVertexItsSlotWithinTheLimits) {
    const formats::Asset asset = tests::with_copied_corners(two_primitives(8));
    EXPECT_TRUE(plan_spread_batches(two_primitives(8).view(), {1 << 20, 256, 1000}).empty());
    for (const DotLimits limits : {DotLimits{1 << 20, 256, 100000}, DotLimits{1 << 20, 4, 5},
                                   DotLimits{600, 32, 1000}, DotLimits{64, 16, 1000}}) {
        std::uint32_t next = 0;
        for (const SpreadBatch& batch : plan_spread_batches(asset.view(), limits)) {
            EXPECT_LE(batch.vertices, limits.max_vertices);
            for (const BoundRange& range : {batch.slot, batch.shown, batch.radiance}) {
                EXPECT_EQ(range.offset % limits.alignment, 0u);
                EXPECT_LE(range.size, limits.max_block_bytes);
            }
            EXPECT_EQ(batch.slot.offset + 4 * batch.slot.origin, 4 * next);
            EXPECT_EQ(batch.radiance.offset + 16 * batch.radiance.origin, 16 * next);
            EXPECT_EQ(batch.shown.offset + 16 * batch.shown.origin, 16 * batch.least_slot);
            for (std::uint32_t v = next; v < next + batch.vertices; ++v) {
                const std::uint32_t slot = asset.slots.slot[v];
                ASSERT_GE(slot, batch.least_slot);
                ASSERT_LE(16 * (batch.shown.origin + slot - batch.least_slot + 1),
                          batch.shown.size);
            }
            next += batch.vertices;
        }
        EXPECT_EQ(next, asset.position.size());
    }
}

TEST(DotBatches, ArraysOfABatchFillItsRangeWithoutOverlapping) {
    for (const std::uint32_t code_bits : {8u, 16u}) {
        const formats::Asset asset = two_primitives(code_bits);
        const formats::AssetView view = asset.view();
        const auto batches = plan_dot_batches(view, {1500, 256, 3});
        ASSERT_TRUE(batches.has_value());
        std::size_t details = 0, end = 0;
        for (const DotBatch& batch : *batches) {
            EXPECT_GE(batch.transport.offset, end);
            end = batch.transport.offset;
            std::size_t bytes = 0;
            for (const PackedArray& array : packed_arrays(view, batch)) {
                EXPECT_EQ(array.offset % 4, 0u);
                EXPECT_GE(array.offset, end);
                EXPECT_LT(array.offset - end, 4u);  // whole words
                end = array.offset + array.bytes.size();
                bytes += array.bytes.size();
            }
            EXPECT_LE(end, batch.transport.offset + batch.transport.size);
            EXPECT_LT(batch.transport.size - bytes, 12u);
            const std::size_t band_rows = std::size_t{batch.slots} * batch.terms * batch.bands;
            details += (bytes - 4 * (batch.slots * batch.terms + 1) - 20 * band_rows) /
                       (2 + batch.bands * code_bits / 8);
        }
        EXPECT_LE(end, transport_bytes(*batches));
        EXPECT_EQ(details, view.transport.index16.size());
    }
}

TEST(DotBatches, OneDispatchPerPrimitiveWhereAllFits) {
    const formats::Asset asset = two_primitives(8);
    const auto batches = plan_dot_batches(asset.view(), {1 << 20, 256, 1 << 20});
    ASSERT_TRUE(batches.has_value());
    EXPECT_EQ(batches->size(), 2u);
}

TEST(DotBatches, RowLargerThanTheLimitIsAnErrorThatNamesIt) {
    const formats::Asset asset = two_primitives(16);
    const auto batches = plan_dot_batches(asset.view(), {256, 4, 1000});
    ASSERT_FALSE(batches.has_value());
    EXPECT_EQ(batches.error().kind, formats::ErrorKind::resource);
    EXPECT_EQ(batches.error().diagnostics[0].where, "primitive 1, vertex 0");
}

}  // namespace
}  // namespace opaline::runtime
