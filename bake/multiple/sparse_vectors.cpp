#include "bake/multiple/sparse_vectors.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace opaline::bake {

void append_truncated(SparseVectors& vectors, std::span<const float> dense, std::size_t kept) {
    const std::size_t face = dense.size() / 6;
    std::vector<std::pair<float, std::uint32_t>> scored;
    std::vector<std::uint32_t> chosen;
    double squares = 0;
    for (std::uint32_t k = 0; k < dense.size(); ++k) {
        squares += static_cast<double>(dense[k]) * static_cast<double>(dense[k]);
        if (k % face == 0) {
            chosen.push_back(k);
        } else if (dense[k] != 0) {
            scored.emplace_back(std::abs(dense[k]), k);
        }
    }
    const std::size_t details = kept > 6 ? kept - 6 : 0;
    if (scored.size() > details) {
        std::nth_element(scored.begin(), scored.begin() + static_cast<std::ptrdiff_t>(details),
                         scored.end(), [](const auto& a, const auto& b) {
                             return a.first != b.first ? a.first > b.first : a.second < b.second;
                         });
        scored.resize(details);
    }
    for (const auto& [magnitude, k] : scored) {
        chosen.push_back(k);
    }
    std::sort(chosen.begin(), chosen.end());
    for (const std::uint32_t k : chosen) {
        vectors.index.push_back(k);
        vectors.value.push_back(dense[k]);
    }
    vectors.offset.push_back(vectors.index.size());
    vectors.norm.push_back(static_cast<float>(std::sqrt(squares)));
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
