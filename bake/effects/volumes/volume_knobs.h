#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "bake/effects/volumes/degree_rate.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knob.h"

namespace opaline::bake {

namespace volume_knobs {
inline bool is_lit(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, Subject::Kind::volume);
}
inline bool is_scattered_often(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, kOftenInVolumes);
}
// Light of surfaces has rows and walks of its own.
inline bool has_rows_by_view(const RowLayout&, std::span<const PlanEntry> decisions) {
    return is_on(decisions, kOftenInVolumes) || is_on(decisions, kSurfacesToVolumes);
}
// Whether a volume's light that is scattered more than once takes that way, or may.
inline bool goes_by(std::span<const PlanEntry> decisions, VolumeMethod method) {
    return std::ranges::any_of(decisions, [&](const PlanEntry& entry) {
        return entry.on && entry.name == kOftenInVolumes &&
               (entry.choice.empty() || entry.choice == name_of(method));
    });
}
inline bool is_walked(const RowLayout&, std::span<const PlanEntry> decisions) {
    return goes_by(decisions, VolumeMethod::walks) || is_on(decisions, kSurfacesToVolumes);
}
inline bool follows_paths(const RowLayout&, std::span<const PlanEntry> decisions) {
    return goes_by(decisions, VolumeMethod::path_integration);
}
// Degree l of 1, 4, 9, ... rows.
inline double degree_of(double rows) {
    return std::sqrt(rows) - 1;
}
}  // namespace volume_knobs

/// Voxels between the nodes at which the light in a volume is known; 0: by its density.
inline constexpr KnobSpec kVolumeSpacing{
    .name = "volume_spacing",
    .option = "--volume-spacing",
    .placeholder = "V",
    .help =
        "voxels between points of a volume at which its light is baked: 1, 2, 4 or 8; default: so "
        "many that little light is lost from one to the next, which is fewer where it is dense",
    .lowest = 1,
    .highest = 8,
    .zero_is_auto = true,
    .allowed = {1, 2, 4, 8},
    .preset = {0, 0, 0, 0},
    .label = "nodes every %g voxels",
    .ladder = {1, 2, 4, 8},
    .truths = {1, 1, 1, 2, 2, 2},
    .theory = {.label = "voxels between nodes",
               .words = "square of the spacing, where light is smooth between nodes",
               .rate = 2,
               .fine_is_small = true},
    .matters = volume_knobs::is_lit};

/// Coefficients of a node.
inline constexpr KnobSpec kVolumeCoefficients{
    .name = "volume_coefficients",
    .option = "--volume-coefficients",
    .placeholder = "M",
    .help =
        "number of coefficients that the rows of such a point keep together in the mean, the six "
        "face averages of each included: a half or a sixth for light that arrives unscattered, the "
        "others for light that was scattered before; points that are seen more keep more; default "
        "as the quality says",
    .lowest = 14,
    .highest = 39936,
    .preset = {272, 544, 1632, 39936},
    .label = "%g coefficients a point of volumes",
    .ladder = {136, 272, 544, 1088, 2176, 4352},
    .diagonal = {272, 544, 816, 1088, 1632},
    .truths = {4352, 4352, 2176, 2176, 1632, 1632},
    .theory = {.label = "coefficients of a point of volumes",
               .words = "edge of a texel, where light is a smooth function of its direction",
               .rate = -0.5},
    .matters = volume_knobs::is_lit};

/// VolumeMethod.
inline constexpr KnobSpec kVolumeMethod{
    .name = "volume_method",
    .option = "--volume-method",
    .placeholder = "auto|path-integration|walks [auto]",
    .help =
        "how light that is scattered more than once in a volume is found: by random walks, or by "
        "most probable paths, which have no noise, err by some 30 % and pay in media so dense "
        "that walks are long; auto: walks, unless paths take less work and their measured error "
        "fits",
    .lowest = 0,
    .highest = 2,
    .words = kVolumeMethodWords,
    .preset = {0, 0, 0, 0},
    .matters = volume_knobs::is_scattered_often};

/// Directions from each node along which quasi-paths begin; twice as many as rows at least.
inline constexpr KnobSpec kVolumePaths{
    .name = "volume_paths",
    .option = "--volume-paths",
    .placeholder = "P",
    .help =
        "directions from each of these points in which most probable paths begin, each path once "
        "for every direction of light, where --volume-method takes them; default as the quality "
        "says",
    .lowest = 1,
    .highest = 4096,
    .preset = {16, 32, 64, 256},
    .label = "%g directions of paths from a node",
    .ladder = {8, 16, 32, 64, 128, 256},
    .diagonal = {8, 16, 32, 64, 128},
    .truths = {256, 256, 256, 128, 128, 64},
    .theory = {.label = "directions of paths from a node",
               .words = "views as even points on a sphere, of light with edges [Beck1984]; the "
                        "error of paths themselves stays",
               .rate = -0.75},
    .matters = volume_knobs::follows_paths};

/// Random walks from each node.
inline constexpr KnobSpec kVolumeWalks{
    .name = "volume_walks",
    .option = "--volume-walks",
    .placeholder = "W",
    .help =
        "random walks from each of these points, which find the light that is scattered more "
        "than once, where media scatter evenly; up to some five times as many where they scatter "
        "forward, for the same noise; default as the quality says",
    .lowest = 1,
    .highest = 65536,
    .preset = {32, 128, 256, 1024},
    .label = "%g walks from a node",
    .ladder = {4, 16, 64, 256, 1024},
    .diagonal = {16, 32, 64, 128, 256},
    .truths = {1024, 512, 512, 256, 256, 128},
    .theory = {.label = "walks from a node", .words = "noise of independent walks", .rate = -0.5},
    .matters = volume_knobs::is_walked};

/// Rows of a node for the dependence of multiple scattering on the view.
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
    .allowed = {1, 4, 9, 16, 25},
    .preset = {0, 0, 0, 0},
    .label = "%g rows of multiple scattering",
    .ladder = {1, 4, 9, 16, 25},
    .theory = {.label = "degree of the rows of multiple scattering",
               .words = "moments of Henyey and Greenstein's phase function without its peak",
               .rate_by_cosine = rate_of_degree,
               .value = volume_knobs::degree_of},
    .matters = volume_knobs::has_rows_by_view};

/// Mean numbers of coefficients of the rows of a node; the face averages are there in any case.
struct NodeCoefficients {
    std::uint32_t attenuated = 0;  ///< of V
    std::uint32_t scattered = 0;   ///< of all T_k together
};

/// V has half of them where one row holds multiple scattering and a sixth where more do.
inline NodeCoefficients node_coefficients(const Knobs& knobs, std::uint32_t terms) {
    const std::uint32_t texels = 6 * knobs.cubemap_size * knobs.cubemap_size;
    const std::uint32_t all = whole(knobs, kVolumeCoefficients);
    const std::uint32_t own = terms == 0 ? all : terms == 1 ? all / 2 : all / 6;
    return {std::clamp(own, 7u, texels), std::clamp(all - own, 7 * terms, texels * terms)};
}

/// So many times these numbers a node may keep, where it is seen well (share_details.h).
inline std::uint32_t node_candidates(Quality quality) {
    constexpr std::array<std::uint32_t, 4> kTimes{4, 4, 2, 1};
    return kTimes[static_cast<std::size_t>(quality)];
}

}  // namespace opaline::bake
