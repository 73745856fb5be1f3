#pragma once

#include <algorithm>
#include <array>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"

namespace opaline::bake {

namespace volume_knobs {
inline bool is_lit(const RowLayout&, std::span<const PlanEntry> decisions) {
    return std::ranges::any_of(decisions, [](const PlanEntry& entry) {
        return entry.on && entry.subject.kind == Subject::Kind::volume;
    });
}
inline bool is_scattered_often(const RowLayout&, std::span<const PlanEntry> decisions) {
    return std::ranges::any_of(decisions, [](const PlanEntry& entry) {
        return entry.on && entry.name == "volume-multiple";
    });
}
inline constexpr const char* kWhyDark = "no volume scatters light";
inline constexpr const char* kWhyOnce = "no light is scattered more than once in a volume";
inline constexpr std::array<double, 4> kSpacings{1, 2, 4, 8};
inline constexpr std::array<double, 5> kTermCounts{1, 4, 9, 16, 25};
}  // namespace volume_knobs

/// Voxels between the nodes at which the light in a volume is known; 0: by its density.
inline constexpr KnobSpec kVolumeSpacing{
    .name = "volume_spacing",
    .option = "--volume-spacing",
    .placeholder = "V",
    .help =
        "voxels between points of a volume at which its light is baked: 1, 2, 4 or 8; default: so "
        "many that little light is lost from one to the next",
    .lowest = 1,
    .highest = 8,
    .zero_is_auto = true,
    .allowed = volume_knobs::kSpacings,
    .preset = {0, 0, 0, 0},
    .matters = volume_knobs::is_lit,
    .why_idle = volume_knobs::kWhyDark};

/// Coefficients of a row of a volume.
inline constexpr KnobSpec kVolumeCoefficients{
    .name = "volume_coefficients",
    .option = "--volume-coefficients",
    .placeholder = "M",
    .help =
        "largest number of coefficients that a row of a volume keeps, the six face averages "
        "included; default as the quality says",
    .lowest = 7,
    .highest = 1536,
    .preset = {24, 32, 96, 1536},
    .matters = volume_knobs::is_lit,
    .why_idle = volume_knobs::kWhyDark};

/// Random walks from each node.
inline constexpr KnobSpec kVolumeWalks{
    .name = "volume_walks",
    .option = "--volume-walks",
    .placeholder = "W",
    .help =
        "random walks from each of these points, which find the light that is scattered more "
        "than once; default as the quality says",
    .lowest = 1,
    .highest = 65536,
    .preset = {16, 64, 256, 1024},
    .matters = volume_knobs::is_scattered_often,
    .why_idle = volume_knobs::kWhyOnce};

/// Rows of a node that say how light that was scattered more than once changes with the view.
inline constexpr KnobSpec kVolumeTerms{
    .name = "volume_terms",
    .option = "--volume-terms",
    .placeholder = "K",
    .help =
        "rows of such a point for light that was scattered more than once: 1, the same for all "
        "views, 4, 9, 16 or 25; default: as the phase function and the quality ask for",
    .lowest = 1,
    .highest = 25,
    .zero_is_auto = true,
    .allowed = volume_knobs::kTermCounts,
    .preset = {0, 0, 0, 0},
    .matters = volume_knobs::is_scattered_often,
    .why_idle = volume_knobs::kWhyOnce};

}  // namespace opaline::bake
