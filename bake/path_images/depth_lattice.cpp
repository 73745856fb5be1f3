#include "bake/path_images/depth_lattice.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

using Grid = formats::SparseGrid<float>;

// Whether a brick of the volume has voxels within `reach` [m] of x along each axis, or one voxel
// more.
bool has_brick_near(const TrackedVolume& volume, glm::vec3 x, float reach) {
    const glm::vec3 index = volume.to_index * x + volume.offset;
    const glm::mat3& m = volume.to_index;
    const glm::vec3 radius = reach * (glm::abs(m[0]) + glm::abs(m[1]) + glm::abs(m[2])) + 1.0f;
    const Grid& grid = volume.volume->density;
    const glm::vec3 side(Grid::kSide);
    const glm::vec3 from =
        glm::max(glm::floor((index - radius) / side), glm::vec3(grid.first_brick));
    const glm::vec3 to = glm::min(glm::floor((index + radius) / side),
                                  glm::vec3(grid.first_brick + grid.extent - 1));
    for (auto z = static_cast<int>(from.z); z <= static_cast<int>(to.z); ++z) {
        for (auto y = static_cast<int>(from.y); y <= static_cast<int>(to.y); ++y) {
            for (auto i = static_cast<int>(from.x); i <= static_cast<int>(to.x); ++i) {
                if (grid.brick_at({i, y, z}) != Grid::kEmpty) {
                    return true;
                }
            }
        }
    }
    return false;
}

std::size_t node_number(const DepthLattice& lattice, glm::ivec3 at) {
    return (static_cast<std::size_t>(at.z) * static_cast<std::size_t>(lattice.count.y) +
            static_cast<std::size_t>(at.y)) *
               static_cast<std::size_t>(lattice.count.x) +
           static_cast<std::size_t>(at.x);
}

DepthLattice lay_out(const VolumeSpace& space, const VolumeBox& box, double spacing) {
    DepthLattice lattice;
    lattice.low = box.low;
    lattice.spacing = spacing;
    lattice.count = glm::ivec3(glm::ceil((box.high - box.low) / spacing)) + 1;
    lattice.slot.assign(node_number(lattice, {0, 0, lattice.count.z}), formats::kNone);
    glm::ivec3 at;
    for (at.z = 0; at.z < lattice.count.z; ++at.z) {
        for (at.y = 0; at.y < lattice.count.y; ++at.y) {
            for (at.x = 0; at.x < lattice.count.x; ++at.x) {
                const glm::vec3 x(box.low + spacing * glm::dvec3(at));
                const bool is_near = std::any_of(
                    space.volumes.begin(), space.volumes.end(), [&](const TrackedVolume& volume) {
                        return has_brick_near(volume, x, static_cast<float>(spacing));
                    });
                if (is_near) {
                    lattice.slot[node_number(lattice, at)] =
                        static_cast<std::uint32_t>(lattice.position.size());
                    lattice.position.push_back(x);
                }
            }
        }
    }
    return lattice;
}

}  // namespace

VolumeBox density_box(const VolumeSpace& space) {
    VolumeBox box{glm::dvec3(1e300), glm::dvec3(-1e300)};
    for (const TrackedVolume& volume : space.volumes) {
        for (const glm::dvec3& corner : volume.volume->density.corners()) {
            box.low = glm::min(box.low, corner);
            box.high = glm::max(box.high, corner);
        }
    }
    return box;
}

double voxel_edge(const VolumeSpace& space) {
    double edge = 1e300;
    for (const TrackedVolume& volume : space.volumes) {
        for (int axis = 0; axis < 3; ++axis) {
            edge = std::min(edge, glm::length(glm::dvec3(volume.volume->density.to_scene[axis])));
        }
    }
    return edge;
}

DepthLattice make_depth_lattice(const VolumeSpace& space, std::size_t most) {
    const VolumeBox box = density_box(space);
    const glm::dvec3 size = box.high - box.low;
    // At most 32 times as many nodes are looked at as are wanted.
    double spacing = std::max(
        voxel_edge(space), std::cbrt(size.x * size.y * size.z / (32 * static_cast<double>(most))));
    DepthLattice lattice = lay_out(space, box, spacing);
    while (lattice.position.size() > most) {
        const double excess =
            static_cast<double>(lattice.position.size()) / static_cast<double>(most);
        spacing *= std::max(1.05, std::cbrt(excess));
        lattice = lay_out(space, box, spacing);
    }
    return lattice;
}

DepthNodes depth_nodes_around(const DepthLattice& lattice, glm::dvec3 x) {
    const glm::dvec3 place = glm::clamp((x - lattice.low) / lattice.spacing, glm::dvec3(0),
                                        glm::dvec3(lattice.count - 1));
    const glm::ivec3 first =
        glm::min(glm::ivec3(place), glm::max(lattice.count - 2, glm::ivec3(0)));
    const glm::dvec3 f = place - glm::dvec3(first);
    DepthNodes around;
    for (unsigned c = 0; c < 8; ++c) {
        const glm::ivec3 high(c & 1, c >> 1 & 1, c >> 2);
        const glm::dvec3 w = glm::mix(1.0 - f, f, glm::dvec3(high));
        const glm::ivec3 at = glm::min(first + high, lattice.count - 1);
        around.slot[c] = lattice.slot[node_number(lattice, at)];
        around.weight[c] = around.slot[c] == formats::kNone ? 0 : w.x * w.y * w.z;
    }
    return around;
}

}  // namespace opaline::bake
