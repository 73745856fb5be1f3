#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/lamps/surface_elements.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What particles brought to the cell of a scatterer.
struct ParticleCell {
    glm::dvec3 power{0};        ///< [lm]
    double weight = 0;          ///< sum of largest bands [lm]
    double weight_squares = 0;  ///< sum of their squares
    double area = 0;            ///< [m^2], of the elements in it
};

/// Of each scatterer; `beyond`: what arrives on the other side of a thin wall.
struct ParticleCells {
    std::vector<ParticleCell> front, beyond;

    bool empty() const { return front.empty(); }
};

/// The cells that elements of surfaces are in, by their middles.
class CellsOfElements {
  public:
    /// `tree`: of `scatterers` of them.
    CellsOfElements(const formats::Scene& scene, const BounceTree& tree, std::size_t scatterers,
                    const ElementLayout& layout);

    ParticleCells sum(std::span<const ElementDeposit> deposits) const;

  private:
    std::size_t scatterers_;
    std::vector<float> area_;                    // of elements
    std::vector<std::uint32_t> front_, beyond_;  // scatterers, or kNone
};

/// Irradiance at scatterers, known at points, becomes that of particles where these say that the
/// points do not stand for their cells: spots and shadows that are smaller. A node of the tree
/// whose sum over cells is that of particles, as far as so many know it, keeps its points; other
/// nodes hand the question down, and scatterers have the mean over their cell. `irradiance`: of one
/// lamp.
void correct_by_particles(const BounceTree& tree, std::span<const ParticleCell> cells,
                          std::span<glm::dvec3> irradiance);

}  // namespace opaline::bake
