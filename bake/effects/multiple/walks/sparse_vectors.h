#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// One unquantised Haar vector with few entries, in ascending order of index.
struct SparseVector {
    std::span<const std::uint32_t> index;
    std::span<const float> value;  ///< SparseVectors::bands for each index
};

/// Many sparse vectors. A block holds the vectors that are computed together, so that hundreds of
/// megabytes are never copied and never grow.
struct SparseVectors {
    struct Block {
        std::vector<std::uint32_t> offset{0};  ///< vectors + 1
        std::vector<std::uint32_t> index;
        std::vector<float> value;  ///< `bands` for each index
    };
    static constexpr std::size_t kPerBlock = 64;
    std::vector<Block> blocks;  ///< each of kPerBlock vectors, the last of as many or fewer
    std::uint32_t bands = 1;    ///< or 3

    std::size_t size() const {
        return blocks.empty() ? 0
                              : (blocks.size() - 1) * kPerBlock + blocks.back().offset.size() - 1;
    }
    /// Precondition: i < size().
    SparseVector operator[](std::size_t i) const {
        const Block& block = blocks[i / kPerBlock];
        const std::size_t first = block.offset[i % kPerBlock];
        const std::size_t count = block.offset[i % kPerBlock + 1] - first;
        return {std::span(block.index).subspan(first, count),
                std::span(block.value).subspan(bands * first, bands * count)};
    }
};

/// Appends the `kept` entries of `dense` with the largest magnitude, times `scale`; ties go to the
/// smaller index. The first entry of each face is always kept. L2-optimal, because the basis is
/// orthonormal.
void append_truncated(SparseVectors::Block& block, std::span<const float> dense, std::size_t kept,
                      float scale = 1);

/// The same of vectors with `bands` values for each index, given band by band: the entries that
/// matter most to the eye. Keeps all if `kept` is as large as a vector.
void append_truncated_bands(SparseVectors::Block& block, std::span<const float> dense,
                            std::uint32_t bands, std::size_t kept, float scale = 1);

/// Appends a vector without entries.
void append_nothing(SparseVectors::Block& block);

/// Reserves memory for a block of vectors with at most `entries` entries each.
void reserve(SparseVectors::Block& block, std::size_t entries);

/// Frees reserved memory that was not used.
void shrink(SparseVectors::Block& block);

/// Euclidean.
float norm(std::span<const float> dense);

}  // namespace opaline::bake
