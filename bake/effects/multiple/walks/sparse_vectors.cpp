#include "bake/effects/multiple/walks/sparse_vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "bake/base/largest.h"

namespace opaline::bake {

namespace {

// Eight independent partial sums.
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

void append_truncated(SparseVectors::Block& block, std::span<const float> dense, std::size_t kept,
                      float scale) {
    append_truncated_bands(block, dense, 1, kept, scale);
}

void append_truncated_bands(SparseVectors::Block& block, std::span<const float> dense,
                            std::uint32_t bands, std::size_t kept, float scale) {
    constexpr std::array<float, 3> kWeight{0.2f, 0.7f, 0.1f};
    const std::size_t size = dense.size() / bands, face = size / 6;
    std::vector<float> score(size);
    for (std::uint32_t b = 0; b < bands; ++b) {
        const float weight = bands == 1 ? 1 : kWeight[b];
        for (std::size_t k = 0; k < size; ++k) {
            score[k] += weight * std::abs(dense[b * size + k]);
        }
    }
    for (std::size_t k = 0; k < size; k += face) {
        score[k] = std::numeric_limits<float>::max();
    }
    for (const std::uint32_t k : find_largest(score, std::max<std::size_t>(kept, 6))) {
        block.index.push_back(k);
        for (std::uint32_t b = 0; b < bands; ++b) {
            block.value.push_back(scale * dense[b * size + k]);
        }
    }
    block.offset.push_back(static_cast<std::uint32_t>(block.index.size()));
}

void append_nothing(SparseVectors::Block& block) {
    block.offset.push_back(block.offset.back());
}

void reserve(SparseVectors::Block& block, std::size_t entries) {
    block.index.reserve(SparseVectors::kPerBlock * entries);
    block.value.reserve(SparseVectors::kPerBlock * entries);
}

void shrink(SparseVectors::Block& block) {
    block.index.shrink_to_fit();
    block.value.shrink_to_fit();
}

float norm(std::span<const float> dense) {
    return static_cast<float>(std::sqrt(sum_of_squares(dense)));
}

}  // namespace opaline::bake
