#include "runtime/gl/dot_batches.h"

#include <gtest/gtest.h>

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
                EXPECT_EQ(batch.first_vertex, next);
                EXPECT_GT(batch.vertices, 0u);
                EXPECT_LE(batch.vertices, limits.max_vertices);
                next += batch.vertices;
                for (const BoundRange& range :
                     {batch.row_offset, batch.index, batch.code, batch.average_scale,
                      batch.detail_scale, batch.average_code, batch.irradiance}) {
                    EXPECT_EQ(range.offset % limits.alignment, 0u);
                    EXPECT_EQ(range.size % 4, 0u);
                    EXPECT_LE(range.size, limits.max_block_bytes);
                }
            }
            EXPECT_EQ(next, asset.position.size());
        }
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
    const auto batches = plan_dot_batches(asset.view(), {128, 4, 1000});
    ASSERT_FALSE(batches.has_value());
    EXPECT_EQ(batches.error().kind, formats::ErrorKind::resource);
    EXPECT_EQ(batches.error().diagnostics[0].where, "primitive 1, vertex 0");
}

}  // namespace
}  // namespace opaline::runtime
