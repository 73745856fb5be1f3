#pragma once

#include <cstdint>

#include "formats/opal/fault.h"
#include "formats/opal/volumes.h"

namespace opaline::formats {

/// Bricks of a volume have coordinates in -kMaxBrick ... kMaxBrick - 1, so that those of its voxels
/// fit into 32 bits with room to spare.
inline constexpr std::int32_t kMaxBrick = 1 << 22;

/// Every count, offset and number that a reader of volumes relies on without further checks:
/// numbers of terms, bands and spacings that exist; ranges inside their arrays, each behind the one
/// of the volume before it; bricks and nodes that their volume has; rows that can be decoded; a
/// finite, invertible `to_world`. Precondition: read by take_volumes, rows.cubemap_size valid; no
/// volumes are fine.
Fault find_volumes_fault(const VolumesView& volumes);

/// What a sound baker never writes: extinction, albedo, moments, phase functions and density out of
/// range, nodes elsewhere than at the corners that refer to them, faulty rows
/// (find_row_value_fault).
/// Precondition: find_volumes_fault found nothing.
Fault find_volume_value_fault(const VolumesView& volumes);

}  // namespace opaline::formats
