#pragma once

#include <cstddef>
#include <cstdint>
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

/// Consecutive vertices of one primitive whose rows a single dispatch can see.
struct DotBatch {
    std::uint32_t first_vertex = 0, vertices = 0;  ///< in the whole asset's numbering
    std::uint32_t bands = 1, terms = 1;
    std::uint32_t first_detail = 0;  ///< row_offset of the first row
    std::uint32_t primitive = 0;
    BoundRange row_offset, index, code, average_scale, detail_scale, average_code, radiance;
    BoundRange product;  ///< where needs_view: <T_k, L> of every row
    BoundRange point;    ///< where needs_view: positions and normals, counted in floats
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

/// Splits all primitives' rows so that every range of every batch keeps the limits; covers every
/// vertex that belongs to a primitive exactly once per primitive. Errors: resource, where a single
/// row exceeds the limit.
formats::Result<std::vector<DotBatch>> plan_dot_batches(const formats::AssetView& asset,
                                                        const DotLimits& limits);

}  // namespace opaline::runtime
