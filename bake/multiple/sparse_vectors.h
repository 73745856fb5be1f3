#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// One unquantised Haar vector of few entries, which ascend by index.
struct SparseVector {
    std::span<const std::uint32_t> index;
    std::span<const float> value;
};

/// Many of them, in blocks of as many as are made together: hundreds of megabytes that are never
/// copied, and never grown.
struct SparseVectors {
    struct Block {
        std::vector<std::uint32_t> offset{0};  ///< vectors + 1
        std::vector<std::uint32_t> index;
        std::vector<float> value;
    };
    static constexpr std::size_t kPerBlock = 64;
    std::vector<Block> blocks;  ///< each of kPerBlock vectors, the last of as many or fewer

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
                std::span(block.value).subspan(first, count)};
    }
};

/// Appends, times `scale`, the `kept` entries of `dense` that are largest in magnitude, ties by
/// index; the first entry of each of its six faces always. L2-optimal, because the basis is
/// orthonormal.
void append_truncated(SparseVectors::Block& block, std::span<const float> dense, std::size_t kept,
                      float scale = 1);

/// Makes room for a block of vectors of `entries` entries each, at most.
void reserve(SparseVectors::Block& block, std::size_t entries);

/// Gives back the room that was not needed.
void shrink(SparseVectors::Block& block);

/// Euclidean.
float norm(std::span<const float> dense);

}  // namespace opaline::bake
