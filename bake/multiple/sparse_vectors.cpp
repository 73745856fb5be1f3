#include "bake/multiple/sparse_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "bake/base/largest.h"

namespace opaline::bake {

namespace {

// In eight partial sums, which do not wait for each other.
double sum_of_squares(std::span<const float> values) {
    std::array<double, 8> sum{};
    std::size_t k = 0;
    for (; k + sum.size() <= values.size(); k += sum.size()) {
        for (std::size_t l = 0; l < sum.size(); ++l) {
            const auto value = static_cast<double>(values[k + l]);
            sum[l] += value * value;
        }
    }
    for (; k < values.size(); ++k) {
        sum[0] += static_cast<double>(values[k]) * static_cast<double>(values[k]);
    }
    return std::accumulate(sum.begin(), sum.end(), 0.0);
}

}  // namespace

void append_truncated(SparseVectors& vectors, std::span<const float> dense, std::size_t kept) {
    const std::size_t face = dense.size() / 6;
    std::vector<float> score(dense.size());
    for (std::size_t k = 0; k < dense.size(); ++k) {
        score[k] = std::abs(dense[k]);
    }
    for (std::size_t k = 0; k < dense.size(); k += face) {
        score[k] = std::numeric_limits<float>::max();
    }
    for (const std::uint32_t k : find_largest(score, std::max<std::size_t>(kept, 6))) {
        vectors.index.push_back(k);
        vectors.value.push_back(dense[k]);
    }
    vectors.offset.push_back(vectors.index.size());
    vectors.norm.push_back(static_cast<float>(std::sqrt(sum_of_squares(dense))));
}

void reserve(SparseVectors& vectors, std::size_t entries) {
    vectors.index.reserve(entries);
    vectors.value.reserve(entries);
}

void append_vectors(SparseVectors& vectors, const SparseVectors& tail) {
    const std::uint64_t base = vectors.index.size();
    for (std::size_t i = 1; i < tail.offset.size(); ++i) {
        vectors.offset.push_back(base + tail.offset[i]);
    }
    vectors.index.insert(vectors.index.end(), tail.index.begin(), tail.index.end());
    vectors.value.insert(vectors.value.end(), tail.value.begin(), tail.value.end());
    vectors.norm.insert(vectors.norm.end(), tail.norm.begin(), tail.norm.end());
}

}  // namespace opaline::bake
