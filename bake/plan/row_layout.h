#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What stands in the rows of a material's vertices.
struct RowLayout {
    bool translucent = false;        ///< otherwise diffuse: one row of one band
    bool occluded = false;           ///< rays find out what stands before the light
    bool direct = false;             ///< the diffuse row is simulated, otherwise zero
    bool multiple = false;           ///< multiple scattering is simulated
    std::uint32_t single_terms = 0;  ///< S, terms of the phase function; 0: no single scattering
    bool local = false;              ///< light leaves the medium where it entered
    bool separate = false;           ///< multiple scattering in a row of its own
    bool glossy = false;             ///< with specular reflection
    bool grey = false;               ///< its three bands coincide: one stands for them
    formats::Rgb tint{1, 1, 1};      ///< times the base colour

    /// Rows of a vertex.
    std::uint32_t terms() const {
        return separate ? 1 + single_terms : single_terms > 1 ? single_terms : 1;
    }
    std::uint32_t bands() const { return translucent && !grey ? 3 : 1; }
    /// Row that the first term of single scattering stands in.
    std::uint32_t first_single() const { return separate ? 1 : 0; }
    /// h_0 with which row 0 is seen: multiple scattering is divided by it.
    double view_of_multiple() const;
};

/// One layout per material of the scene, from what the plan decided.
std::vector<RowLayout> layout_rows(const formats::Scene& scene, const std::vector<PlanEntry>& plan,
                                   const Knobs& knobs);

/// Whether rays are traced: they cross media, or find out what stands before the light of what is
/// simulated.
bool needs_hierarchy(std::span<const RowLayout> layouts);

}  // namespace opaline::bake
