#include "formats/vdb/decode_vdb.h"

#include <openvdb/openvdb.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <array>
#include <exception>
#include <glm/glm.hpp>
#include <ios>
#include <limits>
#include <string_view>
#include <vector>

#include "formats/vdb/grid_file.h"
#include "formats/vdb/limits.h"
#include "formats/vdb/pack_bricks.h"

namespace opaline::formats::vdb {
namespace {

Fault damaged(const std::string& detail) {
    return {"", "it is damaged, or OpenVDB cannot read it" + (detail.empty() ? "" : ": " + detail),
            "write it again with the program that made it, or look at it with vdb_print"};
}

std::string place_of(const ListedGrid& listed) {
    return "grid '" + listed.name + "'";
}

std::string type_of(const ListedGrid& listed) {
    return listed.grid ? listed.grid->valueType() : listed.descriptor.gridType();
}

// "'density' (float), 'flame' (double), 'shape' (float, level set)".
std::string list_grids(const std::vector<ListedGrid>& grids) {
    constexpr std::size_t kEnough = 160;
    std::string list;
    for (const ListedGrid& listed : grids) {
        if (list.size() > kEnough) return list + ", ...";
        const bool is_level_set =
            listed.grid && listed.grid->getGridClass() == openvdb::GRID_LEVEL_SET;
        list += (list.empty() ? "'" : ", '") + listed.name + "' (" + type_of(listed) +
                (is_level_set ? ", level set)" : ")");
    }
    return list;
}

// Index coordinates to the file's space. Precondition: linear. The Jacobian, because the difference
// of two points would lose digits far from the origin.
glm::dmat4 matrix_of(const openvdb::math::MapBase& map) {
    glm::dmat4 matrix(1);
    const openvdb::Vec3d origin = map.applyMap({0, 0, 0});
    for (int row = 0; row < 3; ++row) {
        matrix[3][row] = origin[row];
    }
    for (int column = 0; column < 3; ++column) {
        openvdb::Vec3d edge(0, 0, 0);
        edge[column] = 1;
        const openvdb::Vec3d image = map.applyJacobian(edge);
        for (int row = 0; row < 3; ++row) {
            matrix[column][row] = image[row];
        }
    }
    return matrix;
}

// Why a grid is not a fog volume that we read, as far as it is known without its tree.
std::optional<Fault> check_kind(const ListedGrid& listed) {
    const std::string where = place_of(listed);
    const bool is_known = listed.grid && (listed.grid->isType<openvdb::FloatGrid>() ||
                                          listed.grid->isType<openvdb::Vec3SGrid>());
    if (!is_known) {
        return Fault{where, "its values are of type " + type_of(listed) + ", not float or vec3s",
                     "convert it to float (colours: vec3s)"};
    }
    if (listed.name.size() > kMaxNameBytes) {
        return Fault{where, "its name has more than " + std::to_string(kMaxNameBytes) + " bytes",
                     "give it a shorter name"};
    }
    if (!listed.fault.empty()) {
        return Fault{where, listed.fault, "write it with an invertible transform"};
    }
    switch (listed.grid->getGridClass()) {
        case openvdb::GRID_LEVEL_SET:
            return Fault{where, "it is a level set (distances to a surface), not a fog volume",
                         "convert it to a fog volume"};
        case openvdb::GRID_STAGGERED:
            return Fault{where, "it is a staggered vector field, not a fog volume",
                         "name a grid of densities or colours"};
        case openvdb::GRID_FOG_VOLUME:
        case openvdb::GRID_UNKNOWN:
            break;
    }
    const auto map = listed.grid->constTransform().baseMap();
    if (!map->isLinear()) {
        return Fault{where, "its transform is a frustum", "resample it to a grid of equal voxels"};
    }
    if (!is_invertible_affine(matrix_of(*map))) {
        return Fault{where, "its transform is singular or not finite",
                     "write it with an invertible transform"};
    }
    return {};
}

// How unlikely a grid of floats is to be the density: by its name, as simulators and modellers
// give them, then by whether its file calls it a fog volume.
int rank_density(const ListedGrid& listed) {
    constexpr std::array<std::string_view, 3> kMedia{"smoke", "cloud", "fog"};
    constexpr std::array<std::string_view, 10> kOthers{
        "temp", "heat", "flame", "fire", "fuel", "burn", "emission", "vel", "pressure", "shadow"};
    std::string name = listed.name;
    std::ranges::transform(name, name.begin(), [](unsigned char c) {
        return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    });
    const auto is_in_name = [&](std::string_view word) {
        return name.find(word) != std::string::npos;
    };
    if (listed.name == "density") return 0;
    if (name == "density") return 1;
    if (is_in_name("density")) return 2;
    if (std::ranges::any_of(kMedia, is_in_name)) return 3;
    if (std::ranges::any_of(kOthers, is_in_name)) return 6;
    return listed.grid->getGridClass() == openvdb::GRID_FOG_VOLUME ? 4 : 5;
}

// What may be the density of a file of which nothing is said: the grids of floats that are
// likeliest to be; the only grid, whatever its values.
std::vector<const ListedGrid*> list_densities(const std::vector<ListedGrid>& grids) {
    std::vector<const ListedGrid*> found;
    int least = std::numeric_limits<int>::max();
    for (const ListedGrid& listed : grids) {
        if (check_kind(listed) || !listed.grid->isType<openvdb::FloatGrid>()) continue;
        const int rank = rank_density(listed);
        if (rank > least) continue;
        if (rank < least) found.clear();
        least = rank;
        found.push_back(&listed);
    }
    const bool is_alone = found.empty() && grids.size() == 1 && !check_kind(grids.front());
    if (is_alone) found.push_back(&grids.front());
    return found;
}

// The grids to read, or what stands in the way of it.
std::optional<Fault> select_grids(const std::vector<ListedGrid>& grids,
                                  std::span<const std::string> names,
                                  std::vector<const ListedGrid*>& selected) {
    if (names.empty()) {
        selected = list_densities(grids);
    }
    for (const std::string& name : names) {
        const ListedGrid* found = nullptr;
        for (const ListedGrid& listed : grids) {
            const bool is_exact = listed.name == name;
            if (is_exact || (found == nullptr && listed.descriptor.gridName() == name)) {
                found = &listed;
            }
            if (is_exact) break;
        }
        if (found == nullptr) {
            return Fault{"", "has no grid '" + name + "'; it has " + list_grids(grids),
                         "name one of these"};
        }
        if (std::optional<Fault> fault = check_kind(*found)) return fault;
        selected.push_back(found);
    }
    if (selected.empty() && grids.size() == 1) return check_kind(grids.front());
    if (selected.empty()) {
        return Fault{"", "has no fog volume of floats; it has " + list_grids(grids),
                     "write a fog volume of floats"};
    }
    if (selected.size() > kMaxGrids) {
        return Fault{"", "has more than " + std::to_string(kMaxGrids) + " fog volumes",
                     "name the grids to read"};
    }
    return {};
}

std::optional<Fault> pack_grid(const std::string& name, const ListedGrid& listed, GridFile& file,
                               BrickBudget& budget, ReplyWriter& reply) {
    GridHead head;
    const glm::dmat4 to_scene = matrix_of(*listed.grid->constTransform().baseMap());
    for (int i = 0; i < 16; ++i) {
        head.to_scene[i] = to_scene[i / 4][i % 4];
    }
    const openvdb::GridBase::Ptr loaded = file.load_tree(listed);
    std::optional<Fault> fault;
    if (const auto scalar = openvdb::GridBase::grid<openvdb::FloatGrid>(loaded)) {
        fault = pack_bricks(name, scalar->constTree(), head, budget, reply);
    } else if (const auto color = openvdb::GridBase::grid<openvdb::Vec3SGrid>(loaded)) {
        fault = pack_bricks(name, color->constTree(), head, budget, reply);
    } else {
        fault = damaged("");
    }
    if (fault) {
        fault->where = place_of(listed);
    }
    return fault;
}

}  // namespace

std::optional<Fault> decode_vdb(const std::string& path, std::span<const std::string> names,
                                ReplyWriter& reply) {
    // Trees are freed in parallel: not worth starting threads.
    const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
    try {
        openvdb::initialize();
        GridFile file(path);
        if (file.grids().empty()) {
            return Fault{"", "has no grid", "write a fog volume of floats"};
        }
        std::vector<const ListedGrid*> selected;
        if (std::optional<Fault> fault = select_grids(file.grids(), names, selected)) return fault;
        BrickBudget budget{kMaxBricks, kMaxTableBricks};
        std::vector<std::string> unread;
        std::optional<Fault> first_fault;
        bool is_any_read = false;
        for (const ListedGrid& listed : file.grids()) {
            if (std::find(selected.begin(), selected.end(), &listed) == selected.end()) {
                unread.push_back(listed.name);
            }
        }
        for (std::size_t i = 0; i < selected.size(); ++i) {
            const std::string& name = names.empty() ? selected[i]->name : names[i];
            std::optional<Fault> fault = pack_grid(name, *selected[i], file, budget, reply);
            if (fault && (!names.empty() || !fault->is_of_values)) return fault;
            is_any_read = is_any_read || !fault;
            if (fault) {  // velocities and shadows are no densities
                unread.push_back(name);
                if (!first_fault) first_fault = std::move(fault);
            }
        }
        if (!is_any_read) return first_fault;
        reply.write_end(unread);
        return {};
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::ios_base::failure&) {
        return damaged("it ends too early");
    } catch (const std::exception& error) {
        return damaged(error.what());
    }
}

}  // namespace opaline::formats::vdb
