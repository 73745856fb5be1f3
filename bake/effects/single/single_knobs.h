#pragma once

#include <cmath>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

namespace single_knobs {
inline bool looks_inside(const RowLayout& layout, std::span<const PlanEntry>) {
    return layout.harmonics > 0 && !layout.at_entry;
}
inline bool is_expanded(const RowLayout&, std::span<const PlanEntry> decisions) {
    for (const PlanEntry& entry : decisions) {
        if (entry.name == "single.terms" && entry.terms > 0) return true;
    }
    return false;
}
// g to the degree; nothing for isotropic phase functions.
inline double rate_of_terms(double g) {
    return g == 0 ? 0 : std::log(std::abs(g));
}
// K terms are all degrees up to sqrt(K) - 1.
inline double degree_of(double terms) {
    return std::sqrt(terms) - 1;
}
inline double tolerance_for(double error) {
    return 0.5 * error;
}
}  // namespace single_knobs

/// Points along the inward normal.
inline constexpr KnobSpec kDepthSamples{
    .name = "depth_samples",
    .option = "--depth-samples",
    .placeholder = "D",
    .help =
        "points along the inward normal at which light is looked for that scatters once; "
        "default as the quality says",
    .lowest = 1,
    .highest = 256,
    .preset = {4, 6, 6, 16},
    .label = "%g depth samples",
    .ladder = {1, 2, 4, 6, 8, 16, 32},
    .diagonal = {2, 4, 6, 8, 10},
    .truths = {16, 16, 16, 10, 10, 10},
    .theory = {.label = "depth samples",
               .words = "Gauss-Legendre across the edge of a shadow; faster where light is smooth",
               .rate = -1},
    .matters = single_knobs::looks_inside};

/// Cube map for single scattering. Each texel costs one render of the body. At N = 16 single
/// scattering errs by about 0.6 %, and it is a tenth of the light of a bright medium.
inline constexpr KnobSpec kSingleCubemap{.name = "single_cubemap",
                                         .lowest = 8,
                                         .highest = 128,
                                         .at_most_cubemap = true,
                                         .preset = {8, 16, 16, 64},
                                         .label = "single scattering at N = %g",
                                         .ladder = {8, 16, 32},
                                         .diagonal = {8, 8, 8, 16, 16},
                                         .truths = {32, 32, 32, 16, 16, 16},
                                         .theory = {.label = "cube map of single scattering",
                                                    .words = "a small light's place is known to a "
                                                             "texel",
                                                    .rate = -1},
                                         .matters = single_knobs::looks_inside};

/// K, terms of the phase function; 0: chosen per medium.
inline constexpr KnobSpec kPhaseTerms{
    .name = "phase_terms",
    .option = "--phase-terms",
    .placeholder = "K",
    .help =
        "terms of the phase function: 1, 4, 9, 16 or 25; default: as many as it and the "
        "quality ask for",
    .lowest = 1,
    .highest = 25,
    .zero_is_auto = true,
    .allowed = {1, 4, 9, 16, 25},
    .preset = {0, 0, 0, 0},
    .label = "K = %g",
    .ladder = {1, 4, 9, 16, 25},
    .theory = {.label = "degree of the phase function",
               .words = "Legendre coefficients of a Henyey-Greenstein function: g to the degree",
               .rate_by_cosine = single_knobs::rate_of_terms,
               .value = single_knobs::degree_of},
    .matters = single_knobs::is_expanded};

/// What the terms may leave wrong, as a share of what a half space returns (choose_terms).
inline constexpr KnobSpec kPhaseTolerance{.name = "phase_tolerance",
                                          .lowest = 0,
                                          .highest = 1,
                                          .whole = false,
                                          .preset = {0.05, 0.02, 0.01, 1e-3},
                                          .for_target = single_knobs::tolerance_for};

}  // namespace opaline::bake
