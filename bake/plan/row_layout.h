#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Content of the rows of a material's receivers. Every rule of the plan writes its decision here
/// (DecisionRule::lay_out); nothing else about a decision reaches the stages.
struct RowLayout {
    bool translucent = false;  ///< seen through the boundary of a medium; otherwise diffuse, grey
    bool occluded = false;     ///< visibility is traced
    bool constant = false;     ///< some effect fills a row that is the same for all views
    std::uint32_t harmonics = 0;  ///< rows that are seen through spherical harmonics: 0, 1, 4 … 25
    std::uint32_t view_harmonics = 0;  ///< of these, filled with the light of `constant`: 0, 4 or 9
    bool all_orders = false;           ///< `constant` holds light of all orders of scattering
    bool layered = false;              ///< light goes through other media inside its own
    /// No row holds what crosses the medium unscattered: it counts as bright as what scatters.
    bool fills_crossed = false;
    bool crosses = false;        ///< rows hold what crosses its own medium alone unscattered
    bool at_entry = false;       ///< light leaves the medium where it entered
    bool separate = false;       ///< the row for all views is apart from the harmonics
    bool sheet = false;          ///< a row for each side that it may be seen from
    bool grey = false;           ///< the three bands coincide: one is stored
    bool coloured = false;       ///< light that arrives differs between the three bands
    bool mirrors = false;        ///< its surface mirrors light: needs openness
    bool filtered = false;       ///< its textures, where others see it: means over areas
    formats::Rgb tint{1, 1, 1};  ///< times the base colour
    /// Of the harmonics, those filled with light that nothing scatters: 0, 4 or 9.
    std::uint32_t straight_harmonics = 0;

    bool has_rows() const { return constant || harmonics > 0; }
    /// Rows of a receiver, at least one: a receiver without any is black.
    std::uint32_t terms() const {
        return sheet ? 2 : separate ? 1 + all_harmonics() : std::max(all_harmonics(), 1u);
    }
    std::uint32_t all_harmonics() const {
        return std::max({harmonics, view_harmonics, straight_harmonics});
    }
    std::uint32_t bands() const { return coloured || ((translucent || sheet) && !grey) ? 3 : 1; }
    /// Row of the first harmonic.
    std::uint32_t first_harmonic() const { return separate ? 1 : 0; }
    /// h_0 of row 0: rows for all views are divided by it.
    double view_of_constant() const;
};

/// One layout per material of the scene, from the plan's decisions.
std::vector<RowLayout> layout_rows(const EffectTable& effects, const formats::Scene& scene,
                                   std::span<const PlanEntry> plan, const Knobs& knobs);

/// The layout of one material from some of its decisions.
RowLayout layout_material(const EffectTable& effects, const formats::Material& material,
                          std::span<const PlanEntry> decisions, const Knobs& knobs);

/// Whether rays are traced, through media or for visibility.
bool needs_hierarchy(std::span<const RowLayout> layouts);

}  // namespace opaline::bake
