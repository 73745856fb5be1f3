#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "bake/base/context.h"
#include "bake/exchange/bounce_light.h"
#include "bake/exchange/lamp_bounces.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/effect.h"
#include "bake/trace/coded_rows.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"

namespace opaline::bake {

/// Light that surfaces send to volumes: the radiosity of scatterers as radiance, which is the same
/// in all directions. The BounceLight must outlive it.
struct SeenLight {
    const BounceLight& light;
    std::size_t bands = 1;  ///< of rows of volumes: 1 or 3
    /// Of each scatterer, band after band: radiance per unit of light [W m^-2] from each cell.
    CodedRows rows;
};

/// The sky's light reaches a scatterer through the volumes; what other surfaces have sent to it is
/// dimmed as if it came from the sky there. Incomplete once the context is cancelled.
SeenLight see_surfaces(const BounceLight& light, const DensitySpace& space, const LightCells& cells,
                       std::size_t bands, const Context& context);

/// A place of a surface that a ray meets.
struct MetPlace {
    glm::vec3 position{0}, normal{0};  ///< [m]; unit, of the facet as it is wound
    std::uint32_t material = 0;
    float cosine = 0;  ///< of the ray with the normal
};

/// Adds to `sum`, band after band of cells, the radiance of the scatterer in whose cell a place is,
/// times `weight`, in the bands [first, end). Nothing of a side that sends none: the inside of
/// bodies, and what is behind opaque surfaces.
void add_seen(const SeenLight& seen, const MetPlace& met, const std::array<float, 3>& weight,
              std::size_t first, std::size_t end, std::span<float> sum);

/// Adds the radiance [nit] that views see of lamps and of what these light, times their weights and
/// factors: of lamp e to column e of each band of the row of each factor. It is the radiance of
/// surfaces and volumes that glow, and exitance over pi of the others, the same in all directions;
/// metals and media pass a view on. `solid_angle` [sr] of each view: textures are means over it.
/// `key`: of the random numbers. Any thread; returns the rays traced.
std::uint64_t add_seen_lamps(const LampBounces& light, std::span<const SurfaceView> views,
                             double solid_angle, std::uint64_t key, const DenseRow& row);

}  // namespace opaline::bake
