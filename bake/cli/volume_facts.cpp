#include "bake/cli/volume_facts.h"

#include <algorithm>

namespace opaline::cli {
namespace {

// Offsets, scales, averages, indices and codes of a volume's rows.
std::uint64_t row_bytes(const formats::SparseRowsView& rows, const formats::RowRange& range) {
    const std::uint64_t details =
        rows.row_offset[range.first_row + range.rows] - rows.row_offset[range.first_row];
    const std::uint64_t band_rows = std::uint64_t{range.rows} * range.bands;
    return range.rows * sizeof(std::uint32_t) +
           band_rows * (2 * sizeof(float) + 6 * sizeof(std::int16_t)) +
           details * (rows.index_bytes + range.bands * std::uint64_t{rows.code_bits} / 8);
}

}  // namespace

VolumeFacts volume_facts(const formats::VolumesView& volumes, const formats::VolumeRecord& record) {
    const std::uint64_t bricks = record.brick_count;
    const auto density = volumes.density.subspan(record.first_brick_number * formats::kBrickVoxels,
                                                 bricks * formats::kBrickVoxels);
    VolumeFacts facts;
    facts.active_voxels =
        density.size() - static_cast<std::uint64_t>(std::ranges::count(density, 0));
    const std::uint64_t cells =
        std::uint64_t{record.extent[0]} * record.extent[1] * record.extent[2];
    facts.bytes =
        sizeof(record) + formats::kPhaseEntries * sizeof(float) + cells * sizeof(std::uint32_t) +
        bricks * (sizeof(float) + formats::kBrickVoxels * sizeof(std::uint16_t) +
                  record.corners_of_brick() * sizeof(std::uint32_t)) +
        record.node_count * sizeof(formats::NodeVoxel) + row_bytes(volumes.rows, record.rows());
    return facts;
}

}  // namespace opaline::cli
