#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "formats/opal/result.h"
#include "formats/sparse_grid.h"

namespace opaline::formats {

struct VdbOutputGrid {
    std::string name;                         ///< not empty; differs from those of the other grids
    const SparseGrid<float>* grid = nullptr;  ///< values finite and >= 0
    bool is_half = false;  ///< stored in 16 bits: values up to 65504, relative error 2^-11 from
                           ///< 6.1e-5 on; half the size
};

/// Writes grids as fog volumes to an OpenVDB file: voxels above 0 are active, `to_scene` becomes
/// the index-to-world transform. The file appears whole or not at all. Its bytes depend on the
/// arguments and the versions of OpenVDB and Blosc alone; the identifier in its header, random in
/// OpenVDB's own files, is a hash of the rest.
///
/// Errors: `usage` for a name or a value that the above rules out, a grid without a value > 0, a
/// transform that is not affine and invertible, or voxels below 3e-15 of a cubic unit, which
/// OpenVDB takes for empty; `resource` where the file cannot be written.
Status write_vdb(const std::filesystem::path& file, std::span<const VdbOutputGrid> grids);

}  // namespace opaline::formats
