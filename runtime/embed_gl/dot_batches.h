#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"

namespace opaline::runtime {

/// Part of a buffer that a dispatch binds: `offset` aligned as the driver wants, `origin` the
/// element of the bound part at which the batch's own data begin.
struct BoundRange {
    std::size_t offset = 0, size = 0;  ///< [bytes], size a multiple of 4, at least 4
    std::uint32_t origin = 0;          ///< [elements]
};

/// Consecutive slots of one primitive whose rows a single dispatch can see; where no vertices share
/// rows, each vertex is a slot. All that belongs to the rows lies in one range of one buffer:
/// OpenGL ES promises a shader four buffers only.
struct DotBatch {
    std::uint32_t first_slot = 0, slots = 0;  ///< in the whole asset's numbering
    std::uint32_t first_row = 0;              ///< counted from the primitive's first one
    std::uint32_t bands = 1, terms = 1;
    std::uint32_t primitive = 0;
    std::uint32_t first_detail = 0;  ///< row_offset of the first row
    BoundRange transport;            ///< begins with its rows + 1 row offsets
    /// Where arrays begin in that range, counted in elements of their own size.
    std::uint32_t index = 0, code = 0, average_scale = 0, detail_scale = 0, average_code = 0;
    BoundRange radiance;
    BoundRange product;  ///< where needs_view: <T_k, L> of every row
    BoundRange point;    ///< where needs_view: positions and normals of slots, counted in floats
};

/// Whether a primitive's vertices have several rows, to be added up toward an eye. A single one is
/// what they show from everywhere.
bool needs_view(const formats::PrimitiveRecord& primitive);

struct DotLimits {
    std::size_t max_block_bytes = 0;  ///< of one bound range
    std::size_t alignment = 1;        ///< of offsets, a power of two, at least 4
    std::uint32_t max_vertices = 0;   ///< of one dispatch; translucent: of rows
};

/// Bytes of one vertex's or row's result: four floats, the fourth unused.
inline constexpr std::size_t kRadianceBytes = 16;

/// Elements [first, first + count) of `size` bytes each.
BoundRange bind_elements(std::uint64_t first, std::uint64_t count, std::size_t size,
                         std::size_t alignment);

/// Splits all primitives' rows so that every range of every batch keeps the limits; covers every
/// slot of a primitive exactly once per primitive. Errors: resource, where a single
/// row exceeds the limit.
formats::Result<std::vector<DotBatch>> plan_dot_batches(const formats::AssetView& asset,
                                                        const DotLimits& limits);

/// Size of the buffer of all batches' transport [bytes].
std::size_t transport_bytes(std::span<const DotBatch> batches);

/// An array as it stands in the file, and where it goes in the buffer of transport.
struct PackedArray {
    std::size_t offset = 0;  ///< [bytes]
    std::span<const std::byte> bytes;
};
std::array<PackedArray, 6> packed_arrays(const formats::AssetView& asset, const DotBatch& batch);

}  // namespace opaline::runtime
