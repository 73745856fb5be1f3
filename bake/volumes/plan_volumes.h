#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "bake/volumes/volume_method.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What is baked of one volume.
struct VolumeLayout {
    std::uint32_t volume = 0;       ///< index into Scene::volumes
    std::uint32_t once_terms = 0;   ///< K_s; 0: no light that was scattered once
    std::uint32_t often_terms = 0;  ///< K_m; 0: none that was scattered more often
    std::uint32_t spacing = 1;      ///< voxels between nodes
    std::uint32_t walks = 0;        ///< from each node; 0 where often_terms is
    std::uint32_t views = 0;        ///< directions of quasi-paths from each node; 0 likewise
    /// Automatic: the bake measures both ways (choose_method.h).
    VolumeMethod method = VolumeMethod::walks;
    bool glows = false;            ///< its own light is baked
    std::uint32_t glow_terms = 0;  ///< K_e: of scattered light of volumes; 0: none is
    std::uint32_t glow_walks = 0;  ///< from each node; 0 where glow_terms is
    bool lights_surfaces = false;  ///< what it scatters to surfaces is baked

    bool has_nodes() const { return once_terms > 0 || often_terms > 0 || glow_terms > 0; }
};

struct VolumePlan {
    std::vector<PlanEntry> entries;     ///< two a volume, one more if it glows and one where
                                        ///< there are surfaces, in order; they belong to no rule
    std::vector<VolumeLayout> layouts;  ///< of volumes that are seen at all
};

/// Decides from densities, coefficients and phase functions what to bake; traces nothing. With
/// d = 1 - e^-tau, tau an upper bound on the optical depth of any straight line through the volume,
/// alpha the largest albedo, under light of radiance 1: light scattered once or more is at most
/// alpha d, light scattered more than once at most (alpha d)^2 (README.md, "Bounds").
VolumePlan plan_volumes(const formats::Scene& scene, const Knobs& knobs);

/// Whether surfaces receive light that volumes scatter, by the entries of a plan.
bool lights_surfaces(std::span<const PlanEntry> plan);

/// An upper bound [1] on the radiance of a surface by light that a volume scatters to it, under
/// light of radiance 1: alpha d times (R / D)^2, at most 1, the largest share of a hemisphere,
/// weighted by its cosines, that a ball of radius R around the volume covers at a distance D of its
/// middle; D is that of the nearest of the boxes of the scene's primitives. 0 without surfaces.
double largest_sent_light(const formats::Scene& scene, const formats::Volume& volume);

/// The stage of a bake that finds light scattered more than once, by the ways of its layouts.
const char* scattering_stage(std::span<const VolumeLayout> layouts);

/// Volumes among these that are emitters of the file.
inline std::size_t count_glowing(std::span<const VolumeLayout> layouts) {
    return static_cast<std::size_t>(std::ranges::count(layouts, true, &VolumeLayout::glows));
}

/// An upper bound [W m^-2 sr^-1] on what a volume sends out by itself along any straight line, over
/// all bands; 0 of one that does not glow.
double largest_glow(const formats::Volume& volume);

/// An upper bound [W m^-2 sr^-1] on that light with what all volumes of a scene scatter of it: with
/// s the largest albedo times 1 - e^-tau of all, glow / (1 - s).
double largest_scattered_glow(const formats::Scene& scene, const formats::Volume& volume);

/// Whether it is an emitter of the file, by that bound and by --effects.
bool is_seen_to_glow(const formats::Volume& volume, const Knobs& knobs);

/// An upper bound [1] on the optical depth of any straight line through a volume, by band.
std::array<double, 3> largest_depth(const formats::Volume& volume);

}  // namespace opaline::bake
