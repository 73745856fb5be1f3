#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/clouds.h"
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

/// How much brighter each emitter of a file makes it than a sky of radiance 1: the mean luminance
/// over all surfaces by its light alone over that under the sky, each receiver seen along its
/// normal. NaN where the sky gives no light, or the file has no surfaces.
std::vector<double> compare_with_sky(const formats::AssetView& view);

/// What `opaline info` says of the cloud layers of a file, as JSON and on stdout. Precondition:
/// `clouds` passed read_opal's checks.
nlohmann::ordered_json layers_json(const formats::CloudsView& clouds);
void print_layers(const formats::CloudsView& clouds);

}  // namespace opaline::cli
