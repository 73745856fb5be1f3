#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/sparse_grid.h"

namespace opaline::formats {

/// A fog volume of an OpenVDB file. Values are finite and >= 0, those of inactive voxels are 0;
/// every brick has a value > 0, and there is one at least. Bricks are numbered in the order of the
/// table, so by z, then y, then x; the table is no larger than they need. `to_scene` is the file's
/// own index-to-world transform, in its unit of length.
struct VdbGrid {
    std::string name;
    bool is_color = false;        ///< whether the values are in `color`; else they are in `scalar`
    SparseGrid<float> scalar;     ///< of a grid of floats, stored as such or as halves
    SparseGrid<glm::vec3> color;  ///< of a grid of three floats (Vec3f)
    std::uint64_t active_voxels = 0;
    /// Active voxels with a component that is NaN, or negative by more than a thousandth of the
    /// grid's largest value; a voxel with both counts as NaN. These components became 0, and
    /// smaller negative ones too, which are not counted.
    std::uint64_t not_a_number = 0, negative = 0;
};

struct VdbReadOptions {
    /// The program that reads the file in a process of its own: its main begins as
    /// answer_vdb_request.h says. The default is the running program.
    std::filesystem::path reader = "/proc/self/exe";
    std::uint64_t memory_bytes = 8ull << 30;  ///< address space of that process; not limited where
                                              ///< it was built with a sanitizer
    unsigned cpu_seconds = 120;               ///< > 0
    unsigned wall_seconds = 300;              ///< > 0
    /// Reading stops soon after this becomes true. May be null.
    const std::atomic<bool>* interrupted = nullptr;
};

/// Reads fog volumes of an OpenVDB file: those with these names, in this order. If `names` is
/// empty: the grid of floats that is called density, else those that are likeliest to be one
/// (README.md) and can be read so, in the file's order, or the only grid there is. A name that stands several times in a
/// file can be given as "name[0]", "name[1]". Active tiles are filled in. `unread` (may be null)
/// receives the names of grids that are not in the result, 64 at most.
///
/// Untrusted files are safe to try: a process of its own reads them, so what crashes OpenVDB or
/// makes it run out of bounds does not reach this one (README.md says what that does not cover).
///
/// Errors, `bad_input`: not an OpenVDB file, damaged, or past a limit (limits.h, `options`); no
/// such grid; a named grid that is of other values than float and Vec3f, a level set or a staggered
/// field, or whose transform is a frustum or cannot be inverted; a grid with a background other
/// than 0, no active voxel, no value > 0, an infinite value, more than 0.1 % of active voxels NaN
/// or negative (as VdbGrid counts them), or a voxel whose index coordinates are beyond 2^24; no
/// other grid left if `names` is empty. `resource`: the process cannot be started. `interrupted`.
Result<std::vector<VdbGrid>> read_vdb(const std::filesystem::path& file,
                                      std::span<const std::string> names = {},
                                      const VdbReadOptions& options = {},
                                      std::vector<std::string>* unread = nullptr);

}  // namespace opaline::formats
