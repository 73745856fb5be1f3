#pragma once

#include <filesystem>
#include <vector>

#include "formats/gltf/import_gltf.h"
#include "formats/media/media_file.h"
#include "formats/opal/result.h"
#include "formats/scene.h"
#include "formats/vdb/read_vdb.h"

namespace opaline::formats {

/// Reads the volumes of a media file into the scene, after those that it has. Lengths of grids and
/// transforms are units of the scene [metres_per_unit m]. A scene without triangles gets an origin
/// among its volumes. Gives warnings: about voxels that were repaired. `notes` (may be null) gets
/// lines about grids that are not used.
///
/// Entries of a material become the inside of its meshes, whose surfaces are taken out
/// (fill_body.h).
///
/// Errors, with the scene unchanged: those of read_vdb and fill_body; `bad_input` for a color grid
/// as density, a volume that lies beyond 1e9 m, or one whose voxels hold more than a million mean
/// free paths; `resource` for more than kMaxVolumes.
Result<std::vector<Diagnostic>> load_volumes(const MediaFile& media, double metres_per_unit,
                                             Scene& scene, const VdbReadOptions& reader = {},
                                             std::vector<std::string>* notes = nullptr);

/// A scene without triangles: the volume of an OpenVDB file. What it is made of say the entries of
/// `media` that name that file, or none; other entries are loaded beside it. Without any, the
/// medium is grey, its albedo .99, its phase function isotropic, and its extinction the density in
/// 1/m; a warning says so. Errors: those of load_volumes.
Result<ImportedScene> import_vdb(const std::filesystem::path& path, const MediaFile& media,
                                 double metres_per_unit, const VdbReadOptions& reader = {});

}  // namespace opaline::formats
