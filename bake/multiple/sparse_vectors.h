#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// Unquantised Haar vectors, few entries each: what the gather sums. Entries ascend by index.
struct SparseVectors {
    std::vector<std::uint64_t> offset{0};  ///< vectors + 1
    std::vector<std::uint32_t> index;
    std::vector<float> value;
    std::vector<float> norm;  ///< Euclidean, of each whole vector before truncation

    std::size_t size() const { return offset.size() - 1; }
};

/// Appends the `kept` entries of `dense` that are largest in magnitude, ties by index; the first
/// entry of each of its six faces always. L2-best (translucency.md 3.9).
void append_truncated(SparseVectors& vectors, std::span<const float> dense, std::size_t kept);

/// Makes room for `entries` entries in all.
void reserve(SparseVectors& vectors, std::size_t entries);

/// Appends all vectors of `tail`.
void append_vectors(SparseVectors& vectors, const SparseVectors& tail);

}  // namespace opaline::bake
