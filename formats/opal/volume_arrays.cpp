#include "formats/opal/volume_arrays.h"

#include "formats/opal/row_arrays.h"

namespace opaline::formats {

VolumesHead volumes_head(const VolumesView& volumes) {
    return {static_cast<std::uint32_t>(volumes.records.size()),
            sizeof(VolumeRecord),
            volumes.table.size(),
            volumes.density_scale.size(),
            volumes.corner.size(),
            volumes.node.size(),
            0};
}

std::vector<std::span<const std::byte>> volume_arrays(const VolumesHead& head,
                                                      const VolumesView& volumes,
                                                      const TransportHead& rows) {
    std::vector<std::span<const std::byte>> arrays{
        std::as_bytes(std::span(&head, 1)), std::as_bytes(volumes.records),
        std::as_bytes(volumes.table),       std::as_bytes(volumes.density_scale),
        std::as_bytes(volumes.density),     std::as_bytes(volumes.corner),
        std::as_bytes(volumes.node),        std::as_bytes(volumes.phase)};
    const auto of_rows = row_arrays(rows, volumes.rows);
    arrays.insert(arrays.end(), of_rows.begin(), of_rows.end());
    return arrays;
}

bool take_volumes(SectionCursor& cursor, VolumesView& volumes) {
    VolumesHead head;
    // Scales come before codes: where there are as many as bricks, 512 times that cannot overflow.
    return cursor.take_one(head) && head.record_size == sizeof(VolumeRecord) &&
           cursor.take(head.count, volumes.records) && cursor.take(head.cells, volumes.table) &&
           cursor.take(head.bricks, volumes.density_scale) &&
           cursor.take(head.bricks * kBrickVoxels, volumes.density) &&
           cursor.take(head.corners, volumes.corner) && cursor.take(head.nodes, volumes.node) &&
           cursor.take(std::uint64_t{head.count} * kPhaseEntries, volumes.phase) &&
           take_rows(cursor, volumes.rows);
}

}  // namespace opaline::formats
