#pragma once

#include <cstdint>

#include "formats/opal/volumes.h"

namespace opaline::cli {

/// What `opaline info` counts of a volume.
struct VolumeFacts {
    std::uint64_t active_voxels = 0;  ///< with a density above 0
    std::uint64_t bytes = 0;          ///< of all that belongs to it, decoded

    double bytes_per_active_voxel() const {
        return active_voxels == 0 ? 0
                                  : static_cast<double>(bytes) / static_cast<double>(active_voxels);
    }
};

/// Precondition: `record` is one of `volumes`, which passed read_opal's checks.
VolumeFacts volume_facts(const formats::VolumesView& volumes, const formats::VolumeRecord& record);

}  // namespace opaline::cli
