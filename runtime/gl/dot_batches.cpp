#include "runtime/gl/dot_batches.h"

#include <algorithm>
#include <string>

namespace opaline::runtime {
namespace {

using formats::PrimitiveRecord;
using formats::SparseRowsView;

// Elements [first, first + count) of `size` bytes each.
BoundRange bind_elements(std::uint64_t first, std::uint64_t count, std::size_t size,
                         std::size_t alignment) {
    const std::size_t begin = static_cast<std::size_t>(first) * size;
    const std::size_t end = begin + static_cast<std::size_t>(count) * size;
    BoundRange range;
    range.offset = begin & ~(alignment - 1);
    range.origin = static_cast<std::uint32_t>((begin - range.offset) / size);
    range.size = std::max<std::size_t>(4, (end - range.offset + 3) / 4 * 4);
    return range;
}

DotBatch make_batch(const formats::AssetView& asset, std::uint32_t number, std::uint32_t first,
                    std::uint32_t vertices, std::size_t alignment) {
    const SparseRowsView& rows = asset.transport;
    const PrimitiveRecord& primitive = asset.primitives[number];
    const std::uint32_t bands = primitive.bands, terms = primitive.terms;
    const std::uint64_t row = std::uint64_t{primitive.first_row} + std::uint64_t{first} * terms;
    const std::uint64_t row_count = std::uint64_t{vertices} * terms;
    const std::uint64_t band_row = primitive.first_band_row + std::uint64_t{first} * terms * bands;
    const std::uint32_t begin = rows.row_offset[row], end = rows.row_offset[row + row_count];
    const std::uint64_t code =
        primitive.first_code + std::uint64_t{begin - rows.row_offset[primitive.first_row]} * bands;

    DotBatch batch;
    batch.first_vertex = primitive.first_vertex + first;
    batch.vertices = vertices;
    batch.bands = bands;
    batch.terms = terms;
    batch.first_detail = begin;
    batch.primitive = number;
    batch.row_offset = bind_elements(row, row_count + 1, 4, alignment);
    batch.index = bind_elements(begin, end - begin, rows.index_bytes, alignment);
    batch.code =
        bind_elements(code, std::uint64_t{end - begin} * bands, rows.code_bits / 8, alignment);
    batch.average_scale = bind_elements(band_row, row_count * bands, 4, alignment);
    batch.detail_scale = batch.average_scale;
    batch.average_code = bind_elements(band_row * 6, row_count * bands * 6, 2, alignment);
    batch.radiance = bind_elements(batch.first_vertex, vertices, kRadianceBytes, alignment);
    if (needs_view(primitive)) {
        batch.product = bind_elements(row, row_count, kRadianceBytes, alignment);
        batch.point = bind_elements(std::uint64_t{3} * batch.first_vertex,
                                    std::uint64_t{3} * vertices, sizeof(float), alignment);
    }
    return batch;
}

bool fits(const DotBatch& batch, const DotLimits& limits) {
    return std::uint64_t{batch.vertices} * batch.terms <= limits.max_vertices &&
           std::max({batch.row_offset.size, batch.index.size, batch.code.size,
                     batch.average_scale.size, batch.average_code.size, batch.radiance.size,
                     batch.product.size, batch.point.size}) <= limits.max_block_bytes;
}

}  // namespace

bool needs_view(const PrimitiveRecord& primitive) {
    return primitive.terms > 1;  // diffuse primitives have one
}

formats::Result<std::vector<DotBatch>> plan_dot_batches(const formats::AssetView& asset,
                                                        const DotLimits& limits) {
    std::vector<DotBatch> batches;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const PrimitiveRecord& primitive = asset.primitives[p];
        for (std::uint32_t first = 0; first < primitive.vertex_count;) {
            const auto batch_of = [&](std::uint32_t vertices) {
                return make_batch(asset, p, first, vertices, limits.alignment);
            };
            // The most vertices that fit: ranges grow with their number.
            std::uint32_t fitting = 0, too_many = primitive.vertex_count - first + 1;
            while (too_many - fitting > 1) {
                const std::uint32_t middle = fitting + (too_many - fitting) / 2;
                (fits(batch_of(middle), limits) ? fitting : too_many) = middle;
            }
            if (fitting == 0) {
                return formats::make_error(
                    formats::ErrorKind::resource, {},
                    "primitive " + std::to_string(p) + ", vertex " + std::to_string(first),
                    "one vertex's rows of transport exceed the " +
                        std::to_string(limits.max_block_bytes) +
                        " bytes that a shader may see at once",
                    "render on the CPU");
            }
            batches.push_back(batch_of(fitting));
            first += fitting;
        }
    }
    return batches;
}

}  // namespace opaline::runtime
