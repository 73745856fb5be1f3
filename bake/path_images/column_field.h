#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/path_images/band.h"
#include "bake/path_images/depth_lattice.h"
#include "bake/reference/hit_scene.h"

namespace opaline::bake {

/// int density ds [density m] of each volume along a ray, by the midpoint rule in steps of at most
/// `voxels_per_step` voxels. `direction`: unit; `reach` [m], may be infinite.
using Columns = std::array<double, formats::kMaxVolumes>;
Columns columns_along(const VolumeSpace& space, glm::vec3 from, glm::vec3 direction, float reach,
                      float voxels_per_step = 1);

/// Columns from the nodes of a lattice to infinity in some directions, and whether a surface is in
/// the way. Marched in steps of half the nodes' spacing, at least a voxel. Kept per volume, so that
/// every band, with absorption or without, finds its depth here.
struct ColumnField {
    DepthLattice lattice;
    std::vector<glm::dvec3> toward;  ///< unit
    std::size_t volumes = 0;
    /// value[(slot * volumes + v) * toward.size() + d]; its sign bit: blocked.
    std::vector<float> value;
};

/// `surfaces`: null, or what shadows. Stops early if the context is cancelled.
ColumnField make_column_field(const VolumeSpace& space, const HitScene* surfaces,
                              DepthLattice lattice, std::span<const glm::dvec3> toward,
                              const Context& context);

/// Whether surfaces count.
enum class Shadows { of_everything, of_volumes };

/// Optical depth from a point in a direction of the field, and the share of the nodes around it
/// from which no surface is in the way.
struct FieldDepth {
    double depth = 0, open = 1;

    double visibility() const;  ///< open e^-depth
};

/// The medium is marched as far as nodes are apart, in two steps, then depths are linear between
/// nodes, as in an even medium. Without the march they would be wrong most where they count most:
/// next to a lit surface, where the depth has a kink that nodes do not see.
FieldDepth depth_toward(const ColumnField& field, const BandMedium& medium, glm::dvec3 x,
                        std::size_t direction, Shadows shadows);

}  // namespace opaline::bake
