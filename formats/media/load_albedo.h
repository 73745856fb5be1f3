#pragma once

#include <filesystem>
#include <vector>

#include "formats/media/media_file.h"
#include "formats/opal/result.h"
#include "formats/scene.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats {

/// Reads the grid of albedos that an entry names for a volume, if any: sets `volume.scattering` and
/// `volume.albedo`, to the largest of each band; where all voxels with density have one albedo,
/// that alone. `volume` has its density already, whose transform in its file is `density_space`. A
/// grid of another transform is sampled at the voxels of the density, linear between its own; a
/// warning says so where that loses details. Where the grid has no value the albedo is 0.
///
/// Errors, `bad_input`: those of read_vdb, and albedos above 1 by more than rounding.
Status load_albedo(const VolumeEntry& entry, const std::filesystem::path& file,
                   const glm::dmat4& density_space, const VdbReadOptions& reader, Volume& volume,
                   std::vector<Diagnostic>& warnings);

}  // namespace opaline::formats
