#include "bake/multiple/sparse_vectors.h"

#include <gmock/gmock.h>

#include <cmath>

namespace opaline::bake {
namespace {

using testing::ElementsAre;

TEST(SparseVectors, KeepsAveragesAndTheLargestEntries) {
    std::vector<float> dense(24, 0.0f);  // faces of four entries
    dense[1] = 3, dense[2] = -5, dense[9] = 4, dense[8] = 0.1f;
    SparseVectors vectors;
    append_truncated(vectors, dense, 8);
    EXPECT_THAT(vectors.index, ElementsAre(0, 2, 4, 8, 9, 12, 16, 20));
    EXPECT_EQ(vectors.value[1], -5);
    EXPECT_EQ(vectors.value[3], 0.1f);
    EXPECT_FLOAT_EQ(vectors.norm[0], std::sqrt(9 + 25 + 16 + 0.01f));
}

TEST(SparseVectors, DroppedSquaresAreTheErrorAndFallWithTheNumberKept) {
    std::vector<float> dense(96);
    for (std::size_t k = 0; k < dense.size(); ++k) {
        dense[k] = std::sin(static_cast<float>(3 * k * k + 1));
    }
    double before = 1e9;
    for (const std::size_t kept : {6u, 20u, 50u, 96u, 200u}) {
        SparseVectors vectors;
        append_truncated(vectors, dense, kept);
        double error = 0;
        std::vector<float> back(dense.size(), 0.0f);
        for (std::size_t i = 0; i < vectors.index.size(); ++i) {
            back[vectors.index[i]] = vectors.value[i];
        }
        for (std::size_t k = 0; k < dense.size(); ++k) {
            error += std::pow(static_cast<double>(dense[k] - back[k]), 2);
        }
        EXPECT_LE(error, before);
        before = error;
    }
    EXPECT_EQ(before, 0);
}

TEST(SparseVectors, PartsAppendToTheWhole) {
    std::vector<float> a(12, 1.0f), b(12, 2.0f);
    SparseVectors whole, head, tail;
    append_truncated(whole, a, 12);
    append_truncated(whole, b, 8);
    append_truncated(head, a, 12);
    append_truncated(tail, b, 8);
    append_vectors(head, tail);
    EXPECT_EQ(head.offset, whole.offset);
    EXPECT_EQ(head.index, whole.index);
    EXPECT_EQ(head.value, whole.value);
    EXPECT_EQ(head.norm, whole.norm);
}

}  // namespace
}  // namespace opaline::bake
