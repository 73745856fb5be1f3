#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "bake/effects/volumes/plan_volumes.h"
#include "bake/plan/stage_work.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Seconds of a step of an optical depth through one volume; of a walk's flight to a collision, and
/// the direction after it; of a collision of the reference's paths, its light included.
inline constexpr double kDensityStep = 8.9e-8, kVolumeFlight = 2.4e-7, kTracedCollision = 1.2e-6;

/// Work of baking one volume, in counts; expected values of random counts.
struct VolumeWork {
    double voxels = 0;  ///< in bricks
    double bricks = 0;
    double spacing = 1;  ///< voxels between nodes
    double nodes = 0;
    double cells = 0;        ///< directions of light toward which a node is attenuated
    double depth_steps = 0;  ///< of all optical depths: nodes, cells, and steps through each volume
    double flights = 0;      ///< of all walks of one extinction, the last one of each included
    double collisions = 0;   ///< of them
    double walk_cells = 0;   ///< directions and bands of light that join a walk at a collision
    double tracks = 1;       ///< walks that follow extinctions of their own: 1, or 3 by band
    double walks = 0;        ///< from each node
    double paths = 0;        ///< quasi-paths from each node, and their steps in all; no walks then
    double path_steps = 0;
    /// That is billed: VolumeMethod::automatic as walks, which no other way exceeds then.
    VolumeMethod method = VolumeMethod::walks;
    bool sees_surfaces = false;  ///< walks find light of surfaces, whatever the method is
    double terms = 0;            ///< rows of multiple scattering of each node
    double bands = 1;            ///< of a row
};

/// Counts the work of each layout, in order. Numbers of steps and collisions are means over some
/// nodes, directions and walks through the densities; surfaces are not seen. A pure function of
/// its arguments: milliseconds, as much as a pass over the densities.
std::vector<VolumeWork> count_volume_work(const formats::Scene& scene,
                                          std::span<const VolumeLayout> layouts,
                                          const Knobs& knobs);

/// The work of a bake in units of one scattering of the reference's paths, which takes as long as
/// some 16 steps or as light from 180 directions that joins a walk, on any machine about.
double count_in_scatterings(std::span<const VolumeWork> works);

/// Of light scattered more than once alone, by either way, whichever is taken.
double count_walk_scatterings(const VolumeWork& work);
double count_path_scatterings(const VolumeWork& work);

/// Light scattered once: attenuation and its rows. Light scattered more often: walks or paths, and
/// rows.
Work attenuation_work(const CostInput& input, const VolumeWork& work);
Work scattering_work(const CostInput& input, const VolumeWork& work);

/// Optical depths of `receivers` vertices toward all texels through volumes of these, and their
/// rows to texels and back.
Work dimming_work(const CostInput& input, std::span<const VolumeWork> works, double receivers,
                  double rows);

/// Work of the light that a volume scatters to `receivers` vertices, if its layout has it.
Work sent_light_work(const CostInput& input, const VolumeWork& work, const VolumeLayout& layout,
                     double receivers);

/// Scatterers of surfaces that volumes alone see, and the sky's light there.
Work surface_light_work(const CostInput& input);

/// What they send to volumes, dimmed.
Work seen_surfaces_work(const CostInput& input, std::span<const VolumeWork> works);

/// Bytes in the file: of density and nodes; at most of the rows of light that arrives unscattered,
/// and of those of multiple scattering.
double volume_density_bytes(const VolumeWork& work);
double attenuated_row_bytes(const VolumeWork& work, const Knobs& knobs);
double scattered_row_bytes(const VolumeWork& work, const Knobs& knobs);

/// Memory of one volume [bytes]: density, nodes, optical depths of walks, and rows.
double volume_memory(const VolumeWork& work, const Knobs& knobs);

/// Memory [bytes] of the light that surfaces send to volumes.
double seen_surfaces_memory(std::span<const VolumeWork> works, const Knobs& knobs);

}  // namespace opaline::bake
