#pragma once

#include <algorithm>
#include <array>

#include "bake/plan/knob.h"
#include "bake/plan/row_layout.h"

namespace opaline::bake {

namespace multiple_knobs {
inline bool carries_light(const RowLayout& layout, std::span<const PlanEntry>) {
    return layout.translucent && layout.constant && !layout.at_entry;
}
inline bool is_walked(const RowLayout& layout, std::span<const PlanEntry> decisions) {
    return carries_light(layout, decisions) &&
           std::ranges::any_of(decisions,
                               [](const PlanEntry& entry) { return entry.on && entry.all_orders; });
}

// Below an error of 3 % more than one sample a path pays. A pilot starts there at once.
inline double samples_for(double error) {
    return error < 0.03 ? 240000 : 60000;
}
inline double per_path_for(double error) {
    return error < 0.03 ? 4 : 1;
}
// The error of walks falls with the root of their number. The remaining noise shows as blotches, so
// ten times as many walks are taken as the RMS target needs.
inline double walks_for(double error) {
    return std::clamp(40 / (error * error), 500.0, 40000.0);
}
// The total has production's ratio to walks around a receiver. Fewer would widen the radius.
inline double all_walks_for(double error) {
    return std::clamp(1500 * walks_for(error), 1e6, 4.8e7);
}
inline double sites_for(double error) {
    return error < 0.05 ? 40000 : 20000;
}
inline constexpr std::array<std::string_view, 3> kModels{"auto", "dipole", "walks"};
}  // namespace multiple_knobs

/// Samples on the surface of each medium, at most; exactly, where the user gives them.
inline constexpr KnobSpec kSamples{
    .name = "samples",
    .option = "--samples",
    .placeholder = "S",
    .help =
        "points on the surface of each translucent material; default: as many as its mean free "
        "path asks for",
    .lowest = 16,
    .highest = 10000000,
    .exact_if_given = true,
    .preset = {20000, 60000, 150000, 300000},
    .for_target = multiple_knobs::samples_for,
    .label = "%g samples",
    .ladder = {1000, 2000, 4000, 8000, 16000, 32000, 64000},
    .diagonal = {4000, 8000, 16000, 32000, 64000},
    .truths = {300000, 150000, 150000, 60000, 20000, 20000},
    .theory = {.label = "surface samples",
               .words = "square of the spacing, where transport is smooth at that scale",
               .rate = -1},
    .matters = multiple_knobs::carries_light};

/// MultipleModel.
inline constexpr KnobSpec kMultipleModel{
    .name = "multiple_model",
    .option = "--multiple-model",
    .placeholder = "auto|dipole|walks [auto]",
    .help =
        "how light scattered many times is computed: by random walks in the true shape or by the "
        "dipole of a half space; auto: the dipole where its error fits, else walks",
    .lowest = 0,
    .highest = 2,
    .words = multiple_knobs::kModels,
    .even_media = 1,  // dipole
    .preset = {0, 0, 0, 0},
    .matters = multiple_knobs::carries_light};

/// Rows of a receiver for the dependence of multiple scattering on the view.
inline constexpr KnobSpec kViewTerms{
    .name = "view_terms",
    .option = "--view-terms",
    .placeholder = "K",
    .help =
        "rows of a receiver for light scattered many times that random walks follow: 1, the same "
        "for all views, 4, linear in the view, or 9, of degree two; default: as many as the body "
        "and the quality ask for",
    .lowest = 1,
    .highest = 9,
    .zero_is_auto = true,
    .allowed = {1, 4, 9},
    .preset = {0, 0, 0, 0},
    .label = "K = %g",
    .matters = multiple_knobs::is_walked};

/// Random walks around each receiver: within the radius of sites that its row is fitted to. Draft
/// takes few, since its cube map of 8 errs by more than their noise (skin: a
/// torus of 540 vertices errs by 4.4 % with 2000 around, by 4.7 % with 800).
inline constexpr KnobSpec kWalksAround{.name = "walks_around",
                                       .lowest = 1,
                                       .highest = 1e10,
                                       .preset = {800, 6000, 8000, 40000},
                                       .coarse = 300,
                                       .for_target = multiple_knobs::walks_for};

/// Random walks through each medium in all, at most.
inline constexpr KnobSpec kWalks{.name = "walks",
                                 .lowest = 1000,
                                 .highest = 1e10,
                                 .preset = {400000, 3000000, 12000000, 48000000},
                                 .coarse = 150000,
                                 .for_target = multiple_knobs::all_walks_for};

/// Places on the surface of each medium where they start, at most.
inline constexpr KnobSpec kSites{.name = "sites",
                                 .lowest = 500,
                                 .highest = 1000000,
                                 .preset = {8000, 20000, 40000, 80000},
                                 .for_target = multiple_knobs::sites_for};

/// Surface samples per square of the depth of a medium's source.
inline constexpr KnobSpec kSamplesPerPath{.name = "samples_per_path",
                                          .lowest = 1,
                                          .highest = 64,
                                          .preset = {1, 1, 4, 16},
                                          .for_target = multiple_knobs::per_path_for};

/// GatherOptions::tolerance.
inline constexpr KnobSpec kEpsilon{
    .name = "epsilon",
    .option = "--epsilon",
    .placeholder = "E",
    .help =
        "how far the hierarchical gather may err for one node, as a share of what a half space "
        "returns; 0: none; default as the quality says",
    .lowest = 0,
    .highest = 1,
    .whole = false,
    .preset = {1e-2, 1e-3, 1e-3, 1e-5},
    .label = "epsilon = %g",
    .ladder = {1e-1, 3e-2, 1e-2, 3e-3, 1e-3, 3e-4, 1e-4, 0.0},
    .diagonal = {3.2e-2, 8e-3, 2e-3, 5e-4, 1.25e-4},
    .truths = {1e-4, 1e-4, 1e-4, 3e-4, 3e-4, 3e-4},
    .theory = {.label = "gather tolerance \u03b5",
               .words = "each cluster errs by at most \u03b5 (signs differ, so sums err by less)",
               .rate = 1,
               .fine_is_small = true},
    .matters = multiple_knobs::carries_light};

}  // namespace opaline::bake
