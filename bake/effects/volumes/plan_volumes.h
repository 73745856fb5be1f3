#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/effects/volumes/volume_effects.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What is baked of one volume.
struct VolumeLayout {
    std::uint32_t volume = 0;       ///< index into Scene::volumes
    std::uint32_t once_terms = 0;   ///< K_s; 0: no light that was scattered once
    std::uint32_t often_terms = 0;  ///< K_m; 0: none that was scattered more often
    std::uint32_t joined = 1;       ///< voxels along an edge that are one (coarse_volume.h)
    std::uint32_t spacing = 1;      ///< of these between nodes
    std::uint32_t walks = 0;        ///< from each node; 0 where often_terms is
    std::uint32_t views = 0;        ///< directions of quasi-paths from each node; 0 likewise
    /// Automatic: the bake measures both ways (choose_method.h).
    VolumeMethod method = VolumeMethod::walks;
    bool glows = false;            ///< its own light is baked
    std::uint32_t glow_terms = 0;  ///< K_e: of scattered light of volumes and lamps; 0: none is
    std::uint32_t glow_walks = 0;  ///< from each node; 0 where glow_terms is
    bool lights_surfaces = false;  ///< its scattering to surfaces is baked
    bool sees_sky = true;          ///< rows of multiple scattering hold light of the sky
    bool sees_surfaces = false;    ///< and what surfaces send to the volume
    bool coloured = false;         ///< rows have three bands though all volumes are grey
    std::uint32_t whole = 0;       ///< `volume` before volumes were parted (volume_parts.h)

    bool has_nodes() const { return once_terms > 0 || often_terms > 0 || glow_terms > 0; }
};

struct VolumePlan {
    std::vector<PlanEntry> entries;     ///< two a volume, one more if it glows and two where
                                        ///< there are surfaces, in order; they belong to no rule
    std::vector<VolumeLayout> layouts;  ///< of volumes that are seen at all
};

/// Refuses volumes of fidelity "paper", which bakes do not support. Errors: bad_input, with a
/// remedy.
formats::Status check_bakeable(const formats::Scene& scene);

/// Decides from densities, coefficients and phase functions what to bake; traces nothing. With
/// d = 1 - e^-tau, tau an upper bound on the optical depth of any straight line through the volume,
/// alpha the largest albedo, under light of radiance 1: light scattered once or more is at most
/// alpha d, light scattered more than once at most (alpha d)^2 (README.md, "Bounds").
VolumePlan plan_volumes(const formats::Scene& scene, const Knobs& knobs);

/// Optical depth between two nodes at a typical density there.
double spacing_depth(const Knobs& knobs);

/// Whether surfaces receive light that volumes scatter, by the entries of a plan.
bool lights_surfaces(std::span<const PlanEntry> plan);

/// Whether volumes receive light that surfaces send, by the entries of a plan.
bool sees_surfaces(std::span<const PlanEntry> plan);

/// The same by layouts.
inline bool sees_surfaces(std::span<const VolumeLayout> layouts) {
    return std::ranges::any_of(layouts, &VolumeLayout::sees_surfaces);
}

/// The stage of a bake that finds light scattered more than once, by the ways of its layouts.
const char* scattering_stage(std::span<const VolumeLayout> layouts);

/// Volumes among these that are emitters of the file.
inline std::size_t count_glowing(std::span<const VolumeLayout> layouts) {
    return static_cast<std::size_t>(std::ranges::count(layouts, true, &VolumeLayout::glows));
}

/// Whether it is an emitter of the file, by largest_glow and by --effects.
bool is_seen_to_glow(const formats::Volume& volume, const Knobs& knobs);

}  // namespace opaline::bake
