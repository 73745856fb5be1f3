#include "runtime/embed_gl/dot_batches.h"

#include <algorithm>
#include <string>

#include "formats/opal/cubemap.h"

namespace opaline::runtime {
namespace {

using formats::PrimitiveRecord;
using formats::SparseRowsView;

std::size_t whole_words(std::size_t bytes) {
    return (bytes + 3) / 4 * 4;
}

// What of the file's arrays belongs to a batch: rows, details (pairs of index and codes) and their
// places in the whole asset.
struct BatchRows {
    std::uint64_t row, rows, band_row, band_rows, detail, details, code;
};

BatchRows rows_of(const formats::AssetView& asset, const PrimitiveRecord& primitive,
                  std::uint32_t first, std::uint32_t slots) {
    const std::uint64_t terms = primitive.terms, bands = primitive.bands;
    BatchRows batch{};
    batch.row = primitive.first_row + first * terms;
    batch.rows = slots * terms;
    batch.band_row = primitive.first_band_row + first * terms * bands;
    batch.band_rows = batch.rows * bands;
    const auto& row_offset = asset.transport.row_offset;
    batch.detail = row_offset[batch.row];
    batch.details = row_offset[batch.row + batch.rows] - batch.detail;
    batch.code = primitive.first_code + (batch.detail - row_offset[primitive.first_row]) * bands;
    return batch;
}

// Number of a primitive's first slot in the whole asset.
std::uint32_t first_slot_of(const formats::AssetView& asset, std::uint32_t primitive) {
    return asset.slots.empty() ? asset.primitives[primitive].first_vertex
                               : asset.slots.offset[primitive];
}

DotBatch make_batch(const formats::AssetView& asset, std::uint32_t number, std::uint32_t first,
                    std::uint32_t slots, std::size_t alignment) {
    const SparseRowsView& transport = asset.transport;
    const PrimitiveRecord& primitive = asset.primitives[number];
    const BatchRows rows = rows_of(asset, primitive, first, slots);

    DotBatch batch;
    batch.first_slot = first_slot_of(asset, number) + first;
    batch.slots = slots;
    batch.first_row = first * primitive.terms;
    batch.bands = primitive.bands;
    batch.terms = primitive.terms;
    batch.primitive = number;
    batch.first_detail = static_cast<std::uint32_t>(rows.detail);
    std::size_t end = (rows.rows + 1) * sizeof(std::uint32_t);
    // Elements so far, of the next array's size; makes room for as many as it has.
    const auto place = [&end](std::uint64_t count, std::size_t size) {
        const auto origin = static_cast<std::uint32_t>(end / size);
        end += whole_words(count * size);
        return origin;
    };
    batch.average_scale = place(rows.band_rows, sizeof(float));
    batch.detail_scale = place(rows.band_rows, sizeof(float));
    batch.average_code = place(rows.band_rows * formats::kCubeFaces, sizeof(std::int16_t));
    batch.index = place(rows.details, transport.index_bytes);
    batch.code = place(rows.details * primitive.bands, transport.code_bits / 8);
    batch.transport.size = end;
    batch.radiance = bind_elements(batch.first_slot, slots, kRadianceBytes, alignment);
    if (needs_view(primitive)) {
        batch.product = bind_elements(rows.row, rows.rows, kRadianceBytes, alignment);
        batch.point = bind_elements(std::uint64_t{3} * batch.first_slot, std::uint64_t{3} * slots,
                                    sizeof(float), alignment);
    }
    return batch;
}

bool fits(const DotBatch& batch, const DotLimits& limits) {
    return std::uint64_t{batch.slots} * batch.terms <= limits.max_vertices &&
           std::max({batch.transport.size, batch.radiance.size, batch.product.size,
                     batch.point.size}) <= limits.max_block_bytes;
}

template <class T>
std::span<const std::byte> bytes_of(std::span<const T> values, std::uint64_t first,
                                    std::uint64_t count) {
    return std::as_bytes(values.subspan(first, count));
}

}  // namespace

BoundRange bind_elements(std::uint64_t first, std::uint64_t count, std::size_t size,
                         std::size_t alignment) {
    const std::size_t begin = static_cast<std::size_t>(first) * size;
    const std::size_t end = begin + static_cast<std::size_t>(count) * size;
    BoundRange range;
    range.offset = begin & ~(alignment - 1);
    range.origin = static_cast<std::uint32_t>((begin - range.offset) / size);
    range.size = std::max<std::size_t>(4, whole_words(end - range.offset));
    return range;
}

bool needs_view(const PrimitiveRecord& primitive) {
    return primitive.terms > 1;  // diffuse primitives have one
}

formats::Result<std::vector<DotBatch>> plan_dot_batches(const formats::AssetView& asset,
                                                        const DotLimits& limits) {
    std::vector<DotBatch> batches;
    std::size_t end = 0;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const PrimitiveRecord& primitive = asset.primitives[p];
        const std::uint32_t slots = asset.slot_count(p);
        for (std::uint32_t first = 0; first < slots;) {
            const auto batch_of = [&](std::uint32_t count) {
                return make_batch(asset, p, first, count, limits.alignment);
            };
            // The most slots that fit: ranges grow with their number.
            std::uint32_t fitting = 0, too_many = slots - first + 1;
            while (too_many - fitting > 1) {
                const std::uint32_t middle = fitting + (too_many - fitting) / 2;
                (fits(batch_of(middle), limits) ? fitting : too_many) = middle;
            }
            if (fitting == 0) {
                return formats::make_error(
                    formats::ErrorKind::resource, {},
                    "primitive " + std::to_string(p) + ", vertex " +
                        std::to_string(asset.vertex_of(p, first) - primitive.first_vertex),
                    "one vertex's rows of transport exceed the " +
                        std::to_string(limits.max_block_bytes) +
                        " bytes that a shader may see at once",
                    "render on the CPU");
            }
            batches.push_back(batch_of(fitting));
            BoundRange& transport = batches.back().transport;
            transport.offset = (end + limits.alignment - 1) & ~(limits.alignment - 1);
            end = transport.offset + transport.size;
            first += fitting;
        }
    }
    return batches;
}

std::size_t transport_bytes(std::span<const DotBatch> batches) {
    return batches.empty() ? 0 : batches.back().transport.offset + batches.back().transport.size;
}

std::array<PackedArray, 6> packed_arrays(const formats::AssetView& asset, const DotBatch& batch) {
    const SparseRowsView& transport = asset.transport;
    const PrimitiveRecord& primitive = asset.primitives[batch.primitive];
    const BatchRows rows =
        rows_of(asset, primitive, batch.first_row / primitive.terms, batch.slots);
    const std::uint64_t codes = rows.details * primitive.bands;
    const std::size_t at = batch.transport.offset;
    return {{{at, bytes_of(transport.row_offset, rows.row, rows.rows + 1)},
             {at + std::size_t{batch.average_scale} * sizeof(float),
              bytes_of(transport.average_scale, rows.band_row, rows.band_rows)},
             {at + std::size_t{batch.detail_scale} * sizeof(float),
              bytes_of(transport.detail_scale, rows.band_row, rows.band_rows)},
             {at + std::size_t{batch.average_code} * sizeof(std::int16_t),
              bytes_of(transport.average_code, rows.band_row * formats::kCubeFaces,
                       rows.band_rows * formats::kCubeFaces)},
             {at + std::size_t{batch.index} * transport.index_bytes,
              transport.index_bytes == 2 ? bytes_of(transport.index16, rows.detail, rows.details)
                                         : bytes_of(transport.index32, rows.detail, rows.details)},
             {at + std::size_t{batch.code} * (transport.code_bits / 8),
              transport.code_bits == 8 ? bytes_of(transport.code8, rows.code, codes)
                                       : bytes_of(transport.code16, rows.code, codes)}}};
}

}  // namespace opaline::runtime
