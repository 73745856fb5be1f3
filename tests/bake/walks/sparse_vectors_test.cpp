#include "bake/effects/multiple/walks/sparse_vectors.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

using testing::ElementsAre;

TEST(SparseVectors, KeepsAveragesAndTheLargestEntries) {
    std::vector<float> dense(24, 0.0f);  // faces of four entries
    dense[1] = 3, dense[2] = -5, dense[9] = 4, dense[8] = 0.1f;
    SparseVectors::Block block;
    append_truncated(block, dense, 8, 2);
    EXPECT_THAT(block.index, ElementsAre(0, 2, 4, 8, 9, 12, 16, 20));
    EXPECT_EQ(block.value[1], -10);
    EXPECT_EQ(block.value[3], 0.2f);
    EXPECT_FLOAT_EQ(norm(dense), std::sqrt(9 + 25 + 16 + 0.01f));
}

TEST(SparseVectors, EachIsFoundInItsBlock) {
    SparseVectors vectors;
    constexpr std::size_t kCount = 2 * SparseVectors::kPerBlock + 3;
    for (std::size_t i = 0; i < kCount; ++i) {
        if (i % SparseVectors::kPerBlock == 0) {
            EXPECT_EQ(vectors.size(), i);
            reserve(vectors.blocks.emplace_back(), 7);
        }
        std::vector<float> dense(12);
        dense[1 + i % 11] = static_cast<float>(i + 1);
        append_truncated(vectors.blocks.back(), dense, 7);
        shrink(vectors.blocks.back());
    }
    ASSERT_EQ(vectors.size(), kCount);
    for (std::size_t i = 0; i < kCount; ++i) {
        const SparseVector vector = vectors[i];
        ASSERT_EQ(vector.index.size(), vector.value.size());
        const auto largest = std::ranges::max_element(vector.value) - vector.value.begin();
        EXPECT_EQ(vector.value[static_cast<std::size_t>(largest)], static_cast<float>(i + 1));
        EXPECT_EQ(vector.index[static_cast<std::size_t>(largest)], 1 + i % 11);
    }
}

}  // namespace
}  // namespace opaline::bake
