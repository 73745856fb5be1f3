#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/base/context.h"
#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/density_space.h"
#include "bake/trace/direction_set.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A point of a triangle that a file has.
struct ProxyPoint {
    std::uint32_t primitive = 0, first_index = 0;
    glm::vec3 barycentric{0};
};

/// Rows that stand for transport vectors while receivers are placed: coarse, and cheap.
///
/// Of distant light, a value in [0, 1] for each cell of a cube map, rounded to 1/255, twice: by two
/// rays a cell and by two others, so that the product of two differences has no part of their
/// rounding to a few rays.
///  - toward the outside, the mean over the cell of V max(0, n.w), dimmed by volumes;
///  - through a thin wall, the same behind it;
///  - of an opaque one (is_wall), the same behind it as a side of its own;
///  - into a medium, max(0, -n.w) T(d): d is how far [m] the body goes there, and T(d) =
///    e^(-sigma_eff d) / (1 + 3/4 sigma_s' d) what diffuses as far, with sigma_eff = sqrt(3 sigma_a
///    (sigma_a + sigma_s')).
/// Of each lamp, its straight irradiance [lx] outside, of thin walls on both sides, twice, too.
struct ProxyRows {
    std::size_t cells = 0;  ///< of all sides
    std::size_t sides = 1;  ///< 2 of scenes with opaque walls; the second one of all else is black
    std::size_t lamps = 0;
    std::vector<std::uint8_t> cell;    ///< of the first estimate, then of the second
    std::vector<float> lamp;           ///< likewise
    std::vector<std::uint8_t> hidden;  ///< 1: inside a closed body, where nobody sees it; all 0

    std::size_t size() const { return hidden.size(); }
    std::span<const std::uint8_t> cells_of(std::size_t row, std::size_t estimate) const {
        return std::span(cell).subspan((2 * row + estimate) * cells, cells);
    }
    std::span<const float> lamps_of(std::size_t row, std::size_t estimate) const {
        return std::span(lamp).subspan((2 * row + estimate) * lamps, lamps);
    }
};

/// How a medium diffuses light in the band that carries it farthest.
struct DiffusiveReach {
    float reduced = 0, absorption = 0;  ///< sigma_s', sigma_a [1/m]

    /// How far [m] light spreads before it leaves again: the transport mean free path.
    float spread() const { return 1 / (reduced + absorption); }
    float transmittance(float distance) const;  ///< T(d)
};
DiffusiveReach reach_of(const formats::Medium& medium);

/// What traces them.
class ProxyTracer {
  public:
    /// `cubemap_size`: cells along a face, 8 or 16. More lamps than kMostLamps share columns.
    ProxyTracer(const formats::Scene& scene, const RayScene& rays, std::uint32_t cubemap_size,
                std::span<const LampSources> lamps);
    static constexpr std::size_t kMostLamps = 4;

    ProxyRows no_rows() const;
    /// Of a material with a medium.
    const DiffusiveReach& reach(std::uint32_t material) const { return reach_[material]; }
    /// Appends the rows of points. Returns the number of rays.
    std::uint64_t append(std::span<const ProxyPoint> points, const Context& context,
                         ProxyRows& rows) const;

  private:
    std::uint64_t trace(const ProxyPoint& point, ProxyRows& rows) const;
    std::vector<float> see_through_volumes(glm::vec3 position) const;
    std::uint64_t look_outside(const Receiver& receiver, std::size_t estimate,
                               std::span<float> transport) const;
    std::uint64_t look_inside(const DiffusiveReach& reach, const Receiver& inner,
                              std::size_t estimate, std::span<float> transport) const;

    const formats::Scene& scene_;
    const RayScene& rays_;
    std::array<DirectionSet, 4> directions_;  ///< one for each quarter of a cell
    DensitySpace volumes_;
    LightCells cells_;  ///< of volumes
    std::span<const LampSources> lamps_;
    std::vector<DiffusiveReach> reach_;  ///< by material
};

}  // namespace opaline::bake
