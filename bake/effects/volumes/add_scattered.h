#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/trace/density/attenuation.h"
#include "bake/trace/density/scaled_phase.h"

namespace opaline::bake {

/// Light of all directions that reaches a point between nodes, and is scattered there.
struct ScatteredLight {
    /// Optical depths of the eight nodes around it toward each cell (DepthTable), and their
    /// weights. Depths are interpolated, not light: they are linear where the density is even.
    std::array<const std::uint16_t*, 8> depth{};
    std::array<float, 8> node_weight{};
    glm::vec3 direction{0};  ///< unit, from the eye on: light leaves along its opposite
    const std::array<float, ScaledPhase::kHighestDegree + 1>* phase = nullptr;  ///< p' by power
    std::array<float, 3> weight{};                                              ///< by band
};

/// Adds to `sum`, of `bands` times cells.size() numbers band after band, for each cell l
///     weight p'(direction . l) e^-depth(l).
/// The number of cells is a multiple of 8.
void add_scattered(const ScatteredLight& light, const LightCells& cells, std::size_t bands,
                   float* sum);

}  // namespace opaline::bake
