#include "formats/vdb/write_vdb.h"

#include <openvdb/openvdb.h>
#include <xxhash.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>
#include <utility>

#include "formats/opal/atomic_file.h"
#include "formats/vdb/limits.h"

namespace opaline::formats {
namespace {

// Of openvdb::io::Archive only io::File, which opens the file by itself, and io::Stream, which
// leaves out the positions of the grids, are for use from outside.
class MemoryArchive : public openvdb::io::Archive {
  public:
    std::string bytes_of(const openvdb::GridCPtrVec& grids) const {
        std::ostringstream out;
        out.exceptions(std::ios::failbit | std::ios::badbit);
        write(out, grids, /*seekable=*/true);
        return std::move(out).str();
    }

  private:
    using openvdb::io::Archive::write;
};

// The header: u64 magic, three u32 versions, one flag, then the identifier as text of the form
// 8-4-4-4-12 hexadecimal digits. Programs compare it to see whether a file has changed.
void replace_identifier(std::string& bytes) {
    constexpr std::size_t kBegin = 8 + 3 * 4 + 1, kLength = 36;
    assert(bytes.size() > kBegin + kLength && bytes[kBegin + 8] == '-');
    const std::string_view rest = std::string_view(bytes).substr(kBegin + kLength);
    const XXH128_hash_t hash = XXH3_128bits(rest.data(), rest.size());
    std::size_t digit = 0;
    for (std::size_t i = 0; i < kLength; ++i) {
        if (i != 8 && i != 13 && i != 18 && i != 23) {
            const std::uint64_t half = digit < 16 ? hash.high64 : hash.low64;
            bytes[kBegin + i] = "0123456789abcdef"[half >> (60 - 4 * (digit % 16)) & 15];
            ++digit;
        }
    }
}

std::optional<std::string> find_fault(const VdbOutputGrid& output) {
    constexpr float kMaxHalf = 65504;
    const SparseGrid<float>& grid = *output.grid;
    if (!vdb::is_invertible_affine(grid.to_scene)) {
        return "its transform is not affine and invertible";
    }
    const auto [least, most] = std::minmax_element(grid.value.begin(), grid.value.end());
    if (least == grid.value.end() || !(*most > 0)) return "it has no value above 0";
    if (!std::all_of(grid.value.begin(), grid.value.end(),
                     [](float v) { return std::isfinite(v) && v >= 0; })) {
        return "it has values that are negative or not finite";
    }
    if (output.is_half && *most > kMaxHalf) {
        return "its values exceed 65504 and cannot be stored in 16 bits";
    }
    return {};
}

void fill_tree(const SparseGrid<float>& grid, openvdb::FloatTree& tree) {
    constexpr int kSide = SparseGrid<float>::kSide;
    for (std::size_t place = 0; place < grid.table.size(); ++place) {
        if (grid.table[place] == SparseGrid<float>::kEmpty) continue;
        const std::span<const float> values = grid.brick(grid.table[place]);
        const auto at = static_cast<int>(place);
        const glm::ivec3 brick =
            grid.first_brick + glm::ivec3(at % grid.extent.x, at / grid.extent.x % grid.extent.y,
                                          at / grid.extent.x / grid.extent.y);
        const openvdb::Coord origin(kSide * brick.x, kSide * brick.y, kSide * brick.z);
        auto leaf = std::make_unique<openvdb::FloatTree::LeafNodeType>(origin, 0.0f);
        for (std::size_t i = 0; i < values.size(); ++i) {
            // x fastest here, z fastest there.
            const auto offset = static_cast<openvdb::Index>((i & 7) << 6 | (i & 56) | i >> 6);
            if (values[i] > 0) leaf->setValueOn(offset, values[i]);
        }
        if (!leaf->isEmpty()) tree.addLeaf(leaf.release());
    }
}

// A transform made of a map or a matrix takes the scale from the difference of two points, and so
// loses digits far from the origin: where there is nothing but scale and translation, it is made in
// these steps.
openvdb::math::Transform::Ptr to_transform(const glm::dmat4& matrix) {
    openvdb::Mat4d rows;  // it multiplies rows
    openvdb::Vec3d scale, translation;
    bool is_diagonal = true;
    for (int row = 0; row < 4; ++row) {
        for (int column = 0; column < 4; ++column) {
            rows(row, column) = matrix[row][column];
            is_diagonal = is_diagonal && (row == column || row == 3 || matrix[row][column] == 0);
        }
    }
    if (!is_diagonal) return openvdb::math::Transform::createLinearTransform(rows);
    for (int axis = 0; axis < 3; ++axis) {
        scale[axis] = matrix[axis][axis];
        translation[axis] = matrix[3][axis];
    }
    auto transform = openvdb::math::Transform::createLinearTransform(1.0);
    transform->preScale(scale);
    transform->postTranslate(translation);
    return transform;
}

openvdb::FloatGrid::Ptr to_openvdb(const VdbOutputGrid& output) {
    auto grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(output.name);
    grid->setGridClass(openvdb::GRID_FOG_VOLUME);
    grid->setSaveFloatAsHalf(output.is_half);
    grid->setTransform(to_transform(output.grid->to_scene));
    fill_tree(*output.grid, grid->tree());
    return grid;
}

}  // namespace

Status write_vdb(const std::filesystem::path& file, std::span<const VdbOutputGrid> grids) {
    const auto bad_grid = [&](const std::string& name, const std::string& fault) {
        return make_error(ErrorKind::usage, file.string(), "grid '" + name + "'", fault,
                          "write a fog volume");
    };
    std::set<std::string> names;
    openvdb::GridCPtrVec converted;
    for (const VdbOutputGrid& output : grids) {
        if (output.name.empty() || !names.insert(output.name).second) {
            return bad_grid(output.name, "its name is empty or stands twice");
        }
        if (const std::optional<std::string> fault = find_fault(output)) {
            return bad_grid(output.name, *fault);
        }
        try {
            converted.push_back(to_openvdb(output));
        } catch (const openvdb::ArithmeticError&) {
            return bad_grid(output.name, "its voxels are too small for OpenVDB");
        }
    }
    openvdb::initialize();
    std::string bytes = MemoryArchive().bytes_of(converted);
    replace_identifier(bytes);
    return write_file_atomically(file, bytes);
}

}  // namespace opaline::formats
