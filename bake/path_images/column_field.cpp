#include "bake/path_images/column_field.h"

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
        if (!(around.weight[c] > 0)) {
            continue;
        }
        weights += around.weight[c];
        const float* const value = values_of(field, around.slot[c], direction);
        for (std::size_t v = 0; v < field.volumes; ++v) {
            const auto column = static_cast<double>(std::abs(value[v * field.toward.size()]));
            sum += around.weight[c] * band.extinction[v] * column;
        }
    }
    return weights > 0 ? sum / weights : 0;
}

}  // namespace

Columns columns_along(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float reach,
                      float voxels_per_step) {
    Columns columns{};
    VolumeMarch march(space, from, direction, reach);
    while (const auto segment = march.next()) {
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            if (!(segment->bound[v] > 0)) {
                continue;
            }
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
        if (!(depth.open > 0)) {
            return depth;
        }
    }
    const double reach = field.lattice.spacing;
    const glm::dvec3 d = reach * field.toward[direction];
    depth.depth =
        0.5 * reach * (medium(x + 0.25 * d).extinction() + medium(x + 0.75 * d).extinction());
    depth.depth += depth_between_nodes(field, medium.band, x + d, direction);
    return depth;
}

}  // namespace opaline::bake
