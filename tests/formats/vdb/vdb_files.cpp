#include "tests/formats/vdb/vdb_files.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "formats/vdb/limits.h"

namespace opaline::tests {
namespace {

using openvdb::Coord;
using openvdb::GridBase;

template <class T>
T value_of(glm::vec3 v) {
    return static_cast<T>(v.x);
}
template <>
openvdb::Vec3s value_of(glm::vec3 v) {
    return {v.x, v.y, v.z};
}

Coord coord(glm::ivec3 at) {
    return {at.x, at.y, at.z};
}

openvdb::math::Transform::Ptr transform_of(const FileGrid& given) {
    if (given.is_frustum) {
        return openvdb::math::Transform::createFrustumTransform(
            openvdb::BBoxd({0, 0, 0}, {10, 10, 10}), 0.5, 2.0, 1.0);
    }
    openvdb::Mat4d matrix;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            matrix(row, column) = given.transform[row][column];
        }
    }
    return openvdb::math::Transform::createLinearTransform(matrix);
}

template <class Grid>
GridBase::Ptr build(const FileGrid& given) {
    using Value = typename Grid::ValueType;
    auto grid = Grid::create(value_of<Value>(glm::vec3(given.background)));
    for (const Tile& tile : given.tiles) {
        grid->tree().addTile(static_cast<openvdb::Index>(tile.level), coord(tile.at),
                             value_of<Value>(tile.value), tile.is_active);
    }
    for (const Voxel& voxel : given.voxels) {
        if (voxel.is_active) {
            grid->tree().setValueOn(coord(voxel.at), value_of<Value>(voxel.value));
        } else {
            grid->tree().setValueOff(coord(voxel.at), value_of<Value>(voxel.value));
        }
    }
    return grid;
}

GridBase::Ptr build_any(const FileGrid& given) {
    switch (given.values) {
        case Values::scalar:
        case Values::half:
            return build<openvdb::FloatGrid>(given);
        case Values::color:
            return build<openvdb::Vec3SGrid>(given);
        case Values::real64:
            return build<openvdb::DoubleGrid>(given);
        case Values::int32:
            return build<openvdb::Int32Grid>(given);
    }
    return {};
}

openvdb::GridClass class_of(Kind kind) {
    switch (kind) {
        case Kind::fog:
            return openvdb::GRID_FOG_VOLUME;
        case Kind::level_set:
            return openvdb::GRID_LEVEL_SET;
        case Kind::staggered:
            return openvdb::GRID_STAGGERED;
        case Kind::unknown:
            break;
    }
    return openvdb::GRID_UNKNOWN;
}

}  // namespace

void write_file(const std::filesystem::path& path, const std::vector<FileGrid>& grids,
                const FileOptions& options) {
    openvdb::initialize();
    openvdb::GridPtrVec built;
    for (const FileGrid& given : grids) {
        GridBase::Ptr grid = given.shares_tree ? built.back()->copyGrid() : build_any(given);
        grid->setName(given.name);
        grid->setGridClass(class_of(given.kind));
        grid->setSaveFloatAsHalf(given.values == Values::half);
        grid->setTransform(transform_of(given));
        built.push_back(grid);
    }
    const std::uint32_t compression =
        options.is_compressed ? openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK
                              : openvdb::io::COMPRESS_NONE;
    if (options.has_offsets) {
        openvdb::io::File file(path.string());
        file.setCompression(compression);
        file.write(built);
    } else {
        std::ofstream file(path, std::ios::binary);
        openvdb::io::Stream stream(file);
        stream.setCompression(compression);
        stream.write(built);
    }
}

std::vector<Voxel> box_of_voxels(glm::ivec3 low, glm::ivec3 size) {
    std::vector<Voxel> voxels;
    const auto count = static_cast<float>(size.x * size.y * size.z);
    for (int z = 0; z < size.z; ++z) {
        for (int y = 0; y < size.y; ++y) {
            for (int x = 0; x < size.x; ++x) {
                const float v = static_cast<float>(voxels.size() + 1) / count;
                voxels.push_back({low + glm::ivec3(x, y, z), {v, 1.5f - v, 0.5f * v}});
            }
        }
    }
    return voxels;
}

bool openvdb_finds(const std::filesystem::path& path, const std::string& name,
                   const formats::SparseGrid<float>& grid) {
    openvdb::initialize();
    openvdb::io::File file(path.string());
    file.open(false);
    const auto found = openvdb::GridBase::grid<openvdb::FloatGrid>(file.readGrid(name));
    if (!found || found->getGridClass() != openvdb::GRID_FOG_VOLUME) return false;
    for (auto voxel = found->cbeginValueOn(); voxel; ++voxel) {
        const Coord at = voxel.getCoord();
        if (!voxel.isVoxelValue() || grid.at({at.x(), at.y(), at.z()}) != *voxel) return false;
    }
    const auto above_0 =
        std::count_if(grid.value.begin(), grid.value.end(), [](float v) { return v > 0; });
    const openvdb::Vec3d image = found->indexToWorld(openvdb::Vec3d(1, 2, 3));
    const glm::dvec4 expected = grid.to_scene * glm::dvec4(1, 2, 3, 1);
    return found->activeVoxelCount() == static_cast<openvdb::Index64>(above_0) &&
           glm::length(glm::dvec4(image.x(), image.y(), image.z(), 1) - expected) < 1e-12;
}

std::string read_bytes(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::ostringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
}

void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
}

formats::VdbReadOptions with_program() {
    return {.reader = OPALINE_VDB_READER,
            .memory_bytes = 1ull << 30,
            .cpu_seconds = 60,
            .wall_seconds = 180};
}

formats::Result<std::vector<formats::VdbGrid>> read(const std::filesystem::path& path,
                                                    const std::vector<std::string>& names) {
    return formats::read_vdb(path, names, with_program());
}

std::string message_of(const formats::Result<std::vector<formats::VdbGrid>>& result) {
    if (result) return "";
    const formats::Diagnostic& said = result.error().diagnostics.at(0);
    return said.where + ": " + said.fault + " (" + said.remedy + ")";
}

bool is_sound(const formats::VdbGrid& grid) {
    const auto check = [](const auto& sparse, std::span<const float> floats) {
        const std::size_t places = static_cast<std::size_t>(sparse.extent.x) *
                                   static_cast<std::size_t>(sparse.extent.y) *
                                   static_cast<std::size_t>(sparse.extent.z);
        std::uint32_t next = 0;
        for (const std::uint32_t brick : sparse.table) {
            if (brick != sparse.kEmpty && brick != next++) return false;
        }
        return sparse.table.size() == places && next == sparse.brick_count() && next > 0 &&
               formats::vdb::is_invertible_affine(sparse.to_scene) &&
               std::all_of(floats.begin(), floats.end(),
                           [](float v) { return std::isfinite(v) && v >= 0; });
    };
    if (!grid.is_color) return grid.color.empty() && check(grid.scalar, grid.scalar.value);
    const auto* first = reinterpret_cast<const float*>(grid.color.value.data());
    return grid.scalar.empty() && check(grid.color, std::span(first, 3 * grid.color.value.size()));
}

}  // namespace opaline::tests
