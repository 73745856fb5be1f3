#include "bake/lab/path_images/column_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {
namespace {

const float* values_of(const ColumnField& field, std::uint32_t slot, std::size_t direction) {
    return field.value.data() + std::size_t{slot} * field.volumes * field.toward.size() + direction;
}

// The share of the weights of the nodes around a point from which no surface is in the way.
double open_share(const ColumnField& field, glm::dvec3 x, std::size_t direction) {
    const DepthNodes around = depth_nodes_around(field.lattice, x);
    double weights = 0, open = 0;
    for (std::size_t c = 0; c < around.slot.size(); ++c) {
        if (around.weight[c] > 0) {
            weights += around.weight[c];
            open +=
                std::signbit(*values_of(field, around.slot[c], direction)) ? 0 : around.weight[c];
        }
    }
    return weights > 0 ? open / weights : 1;
}

// Optical depth, linear between nodes; 0 where there is no density.
double depth_between_nodes(const ColumnField& field, const MediumBand& band, glm::dvec3 x,
                           std::size_t direction) {
    const DepthNodes around = depth_nodes_around(field.lattice, x);
    double sum = 0, weights = 0;
    for (std::size_t c = 0; c < around.slot.size(); ++c) {
        if (!(around.weight[c] > 0)) continue;
        weights += around.weight[c];
        const float* const value = values_of(field, around.slot[c], direction);
        for (std::size_t v = 0; v < field.volumes; ++v) {
            const auto column = static_cast<double>(std::abs(value[v * field.toward.size()]));
            sum += around.weight[c] * band.extinction[v] * column;
        }
    }
    return weights > 0 ? sum / weights : 0;
}

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

Columns columns_along(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float reach,
                      float voxels_per_step) {
    Columns columns{};
    VolumeMarch march(space, from, direction, reach);
    while (const auto segment = march.next()) {
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            if (!(segment->bound[v] > 0)) continue;
            const TrackedVolume& volume = space.volumes[v];
            const float length = segment->end - segment->begin;
            const float voxels = length * glm::length(volume.to_index * direction);
            const float steps = std::max(std::ceil(voxels / voxels_per_step), 1.0f),
                        ds = length / steps;
            double sum = 0;
            for (float i = 0; i < steps; ++i) {
                sum += static_cast<double>(
                    volume.density(from + (segment->begin + (i + 0.5f) * ds) * direction));
            }
            columns[v] += sum * static_cast<double>(ds);
        }
    }
    return columns;
}

ColumnField make_column_field(const VolumeSpace& space, const HitScene* surfaces,
                              DepthLattice lattice, std::span<const glm::dvec3> toward,
                              const Context& context) {
    constexpr float kForever = std::numeric_limits<float>::infinity();
    const double edge = voxel_edge(space);
    ColumnField field;
    field.lattice = std::move(lattice);
    field.toward.assign(toward.begin(), toward.end());
    field.volumes = space.volumes.size();
    const std::size_t per_node = field.volumes * toward.size();
    const std::size_t nodes = field.lattice.position.size();
    const auto coarse = static_cast<float>(std::max(1.0, 0.5 * field.lattice.spacing / edge));
    field.value.resize(nodes * per_node);
    for_each_block_in_order(
        toward.empty() ? 0 : nodes, 256, context,
        [&](Range range) {
            for (std::size_t node = range.begin; node < range.end; ++node) {
                const glm::vec3 x = field.lattice.position[node];
                for (std::size_t d = 0; d < toward.size(); ++d) {
                    const glm::vec3 direction(toward[d]);
                    const Columns columns = columns_along(space, x, direction, kForever, coarse);
                    const bool is_blocked =
                        surfaces != nullptr && surfaces->is_blocked({x}, direction);
                    for (std::size_t v = 0; v < field.volumes; ++v) {
                        const auto column = static_cast<float>(columns[v]);
                        field.value[node * per_node + v * toward.size() + d] =
                            is_blocked ? -column : column;
                    }
                }
            }
            return range.end;
        },
        [&](Range, std::size_t done) {
            if (context.on_progress) {
                context.on_progress({"depths toward the light", done, nodes});
            }
        });
    return field;
}

double FieldDepth::visibility() const {
    return open * std::exp(-depth);
}

FieldDepth depth_toward(const ColumnField& field, const BandMedium& medium, glm::dvec3 x,
                        std::size_t direction, Shadows shadows) {
    FieldDepth depth;
    if (shadows == Shadows::of_everything) {
        depth.open = open_share(field, x, direction);
        if (!(depth.open > 0)) return depth;
    }
    const double reach = field.lattice.spacing;
    const glm::dvec3 d = reach * field.toward[direction];
    depth.depth =
        0.5 * reach * (medium(x + 0.25 * d).extinction() + medium(x + 0.75 * d).extinction());
    depth.depth += depth_between_nodes(field, medium.band, x + d, direction);
    return depth;
}

std::vector<MediumBand> make_bands(const VolumeSpace& space) {
    std::vector<MediumBand> bands;
    for (int c = 0; c < 3; ++c) {
        MediumBand band;
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            const TrackedVolume& volume = space.volumes[v];
            band.extinction[v] = static_cast<double>(volume.sigma_t[c]);
            const formats::Rgb albedo = volume.volume->albedo;
            band.scattering[v] = band.extinction[v] * static_cast<double>(c == 0   ? albedo.r
                                                                          : c == 1 ? albedo.g
                                                                                   : albedo.b);
        }
        auto same = std::find(bands.begin(), bands.end(), band);
        if (same == bands.end()) {
            same = bands.insert(bands.end(), band);
        }
        same->channel[static_cast<std::size_t>(c)] = true;
    }
    return bands;
}

MediumBand without_absorption(MediumBand band) {
    band.extinction = band.scattering;
    return band;
}

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
