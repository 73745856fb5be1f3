#pragma once

#include <filesystem>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "formats/sparse_grid.h"
#include "formats/vdb/read_vdb.h"

/// OpenVDB files with what a test wants, written by OpenVDB itself.
namespace opaline::tests {

enum class Values { scalar, half, color, real64, int32 };
enum class Kind { fog, level_set, staggered, unknown };

struct Voxel {
    glm::ivec3 at;
    glm::vec3 value;  ///< x alone, but for colours
    bool is_active = true;
};

struct Tile {
    int level;  ///< 1: 8^3 voxels, 2: 128^3, 3: 4096^3
    glm::ivec3 at;
    glm::vec3 value;
    bool is_active = true;
};

struct FileGrid {
    std::string name = "density";
    Values values = Values::scalar;
    Kind kind = Kind::fog;
    float background = 0;
    glm::dmat4 transform{1};
    bool is_frustum = false;
    bool shares_tree = false;  ///< that of the grid before; of the same values
    std::vector<Voxel> voxels = {};
    std::vector<Tile> tiles = {};
};

struct FileOptions {
    bool has_offsets = true;  ///< false: as written to a pipe
    bool is_compressed = true;
};

void write_file(const std::filesystem::path& path, const std::vector<FileGrid>& grids,
                const FileOptions& options = {});

/// A box of voxels from `low` on, each with a value of its own in (0, 1]; colours differ by
/// channel.
std::vector<Voxel> box_of_voxels(glm::ivec3 low, glm::ivec3 size);

/// Whether OpenVDB itself reads the file, and the voxels of its first grid are these and no others.
bool openvdb_finds(const std::filesystem::path& path, const std::string& name,
                   const formats::SparseGrid<float>& grid);

std::string read_bytes(const std::filesystem::path& path);
void write_bytes(const std::filesystem::path& path, const std::string& bytes);

/// Reads with the program `opaline`; the process gets 1 GiB of memory and 20 s.
formats::VdbReadOptions with_program();
formats::Result<std::vector<formats::VdbGrid>> read(const std::filesystem::path& path,
                                                    const std::vector<std::string>& names = {});

/// What an error says, in one line; "" for a success.
std::string message_of(const formats::Result<std::vector<formats::VdbGrid>>& result);

/// Whether the grid is all that VdbGrid promises.
bool is_sound(const formats::VdbGrid& grid);

}  // namespace opaline::tests
