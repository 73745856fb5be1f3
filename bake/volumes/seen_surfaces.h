#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/receiver.h"
#include "bake/transport/coded_rows.h"
#include "bake/transport/density/attenuation.h"
#include "bake/transport/density/density_space.h"
#include "bake/volumes/walk_parts.h"
#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Surfaces of a scene as a file shows them: what `find_seen_surfaces` reads.
struct ShownSurfaces {
    const formats::Scene& scene;
    std::span<const RowLayout> layouts;      ///< by material
    std::span<const ReceiverSet> receivers;  ///< in the order of the scene's primitives
    const formats::AssetView& asset;         ///< rows that no volume has dimmed
};

/// Light that surfaces send to volumes. The scene and its layouts must outlive it.
struct SeenSurfaces {
    const formats::Scene& scene;
    std::span<const RowLayout> layouts;
    std::size_t bands = 1;  ///< of rows of volumes: 1 or 3
    /// By primitive: its first row, and rows of a vertex: two for a sheet, front and back.
    struct Rows {
        std::size_t first = 0, sides = 1;
    };
    std::vector<Rows> primitive;
    /// Of each side, band after band: radiance without the base colour, per unit of light [W m^-2]
    /// from each cell.
    CodedRows rows;
};

/// Memory [bytes] of SeenSurfaces::rows.
double seen_surfaces_bytes(const ShownSurfaces& shown, std::size_t bands, std::size_t cells);

/// Exitance rows of all vertices, taken as diffuse: of opaque and thin-walled surfaces their rows,
/// of media the mean over views of the light that crosses the boundary. The sky's light reaches a
/// vertex through the volumes, as in dim_surfaces. `bands`: of the result, 3 where any row has
/// three. Incomplete once the context is cancelled.
SeenSurfaces find_seen_surfaces(const ShownSurfaces& shown, const DensitySpace& space,
                                const LightCells& cells, std::size_t bands, const Context& context);

/// Adds to `sum`, band after band of cells, the radiance of the surface that a walk has met in its
/// `direction`, times `weight`, in the bands [first, end): that of one corner of the triangle,
/// drawn by `random` in [0, 1), under the colour of the point. The inside of bodies and what is
/// behind opaque surfaces is black, also of double-sided ones, whose rows are those of the side of
/// their normals.
void add_seen_surface(const SeenSurfaces& seen, const MetSurface& met, glm::vec3 direction,
                      const std::array<float, 3>& weight, std::size_t first, std::size_t end,
                      float random, std::span<float> sum);

}  // namespace opaline::bake
