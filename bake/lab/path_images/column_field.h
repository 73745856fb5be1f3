#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/physics/path_integral/grid_medium.h"
#include "bake/reference/hit_scene.h"
#include "bake/reference/volume_space.h"

namespace opaline::bake {

/// Nodes of a cubic lattice, those near density alone.
struct DepthLattice {
    glm::dvec3 low{0};   ///< [m] of node (0, 0, 0)
    double spacing = 1;  ///< [m]
    glm::ivec3 count{0};
    std::vector<std::uint32_t> slot;  ///< by node, x fastest; formats::kNone: far from density
    std::vector<glm::vec3> position;  ///< [m] by slot
};

/// The box [m] in which density may be.
VolumeBox density_box(const VolumeSpace& space);

/// The shortest edge of a voxel [m].
double voxel_edge(const VolumeSpace& space);

/// Nodes as far apart as voxels, or farther where there would be more than `most` of them. Every
/// point with density has all eight nodes around it.
DepthLattice make_depth_lattice(const VolumeSpace& space, std::size_t most);

/// The eight nodes around a point, and their shares.
struct DepthNodes {
    std::array<std::uint32_t, 8> slot;
    std::array<double, 8>
        weight;  ///< sum 1, where there is density; 0 for nodes that are far from density
};
DepthNodes depth_nodes_around(const DepthLattice& lattice, glm::dvec3 x);

/// The coefficients of all volumes in channels that have the same [1/m where a density is 1].
struct MediumBand {
    std::array<double, formats::kMaxVolumes> scattering{}, extinction{};  ///< by volume
    std::array<bool, 3> channel{};                                        ///< that it stands for

    bool operator==(const MediumBand& other) const {
        return scattering == other.scattering && extinction == other.extinction;
    }
};

/// One band for a grey scene, else one for each set of equal channels.
std::vector<MediumBand> make_bands(const VolumeSpace& space);

/// The same medium without absorption.
MediumBand without_absorption(MediumBand band);

/// The sum of all volumes in a band, as the functions of physics/path_integral/ take it. Refers to
/// both.
struct BandMedium {
    const VolumeSpace& space;
    const MediumBand& band;

    Coefficients operator()(glm::dvec3 x) const {
        Coefficients sum;
        for (std::size_t v = 0; v < space.volumes.size(); ++v) {
            const auto density = static_cast<double>(space.volumes[v].density(glm::vec3(x)));
            sum.scattering += band.scattering[v] * density;
            sum.absorption += (band.extinction[v] - band.scattering[v]) * density;
        }
        return sum;
    }
};

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
