#include "bake/path_images/column_field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {

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
                              NodeLattice lattice, std::span<const glm::dvec3> directions,
                              const Context& context) {
    constexpr float kForever = std::numeric_limits<float>::infinity();
    ColumnField field{std::move(lattice), directions.size(), space.volumes.size(), {}};
    const std::size_t per_node = field.volumes * field.directions;
    const std::size_t nodes = field.lattice.position.size();
    const auto coarse =
        static_cast<float>(std::max(1.0, 0.5 * field.lattice.spacing / voxel_edge(space)));
    field.value.resize(nodes * per_node);
    for_each_block_in_order(
        directions.empty() ? 0 : nodes, 256, context,
        [&](Range range) {
            for (std::size_t node = range.begin; node < range.end; ++node) {
                const glm::vec3 x = field.lattice.position[node];
                for (std::size_t d = 0; d < directions.size(); ++d) {
                    const glm::vec3 direction(directions[d]);
                    const Columns columns = columns_along(space, x, direction, kForever, coarse);
                    const bool is_blocked =
                        surfaces != nullptr && surfaces->is_blocked({x}, direction);
                    for (std::size_t v = 0; v < field.volumes; ++v) {
                        const auto column = static_cast<float>(columns[v]);
                        field.value[node * per_node + v * field.directions + d] =
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

FieldDepth depth_toward(const ColumnField& field, const NodesAround& around, std::size_t direction,
                        const Band& band, Shadows shadows) {
    double sum = 0, weights = 0, open = 0;
    for (std::size_t c = 0; c < around.slot.size(); ++c) {
        if (!(around.weight[c] > 0)) {
            continue;
        }
        weights += around.weight[c];
        const float* const value = field.value.data() +
                                   std::size_t{around.slot[c]} * field.volumes * field.directions +
                                   direction;
        if (shadows == Shadows::of_everything && std::signbit(*value)) {
            continue;
        }
        open += around.weight[c];
        for (std::size_t v = 0; v < field.volumes; ++v) {
            const auto column = static_cast<double>(std::abs(value[v * field.directions]));
            sum += around.weight[c] * band.extinction[v] * column;
        }
    }
    if (!(open > 0)) {
        return {0, weights > 0 ? 0.0 : 1.0};
    }
    return {sum / open, open / weights};
}

}  // namespace opaline::bake
