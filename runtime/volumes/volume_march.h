#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "formats/opal/volumes.h"
#include "runtime/volumes/relight_volumes.h"
#include "runtime/volumes/volume_lattice.h"

namespace opaline::runtime {

/// All volumes under one light, ready for rays; refers to the asset and to the light.
struct LitVolumes {
    struct Entry {
        VolumeLattice lattice;
        std::size_t volume = 0;  ///< its number in the asset
        VolumeGlow glow;         ///< its own light
    };
    std::vector<Entry> entry;
    const VolumeLight* light = nullptr;
};

/// Preconditions: `light` is of these volumes and outlives the result, as their arrays do.
LitVolumes light_volumes(const formats::VolumesView& volumes, const VolumeLight& light);

/// Distances t from `origin` along `direction` with begin <= t <= end.
struct MarchRay {
    formats::Vec3 origin;     ///< [m], world
    formats::Vec3 direction;  ///< unit
    double begin = 0;         ///< [m], not below 0
    double end = std::numeric_limits<double>::infinity();
};

struct MarchOptions {
    /// Length of a step, at most, in voxels of the finest volume around it; in [1/64, 8].
    float step = 0.5f;
    float least_transmittance = 1e-3f;  ///< below it in all bands the rest counts as opaque
};

struct MarchResult {
    formats::Rgb radiance;  ///< scattered or sent out toward the origin [W m^-2 sr^-1]
    formats::Rgb transmittance{1, 1, 1};  ///< of light from behind
};

/// Light that volumes add to a ray seen from its origin, and their transmittance of light from
/// behind:
///
///     L = int_begin^end T(t) sum_v (sigma_t,v albedo_v density_v(t) max(0, J_v(t, -direction)) +
///                                   glow_v(t)) dt,
///     T(t) = exp(-int_begin^t sum_v sigma_t,v density_v),
///
/// per band, v over all volumes, also where they overlap. Density is trilinear between voxels, J
/// between nodes (volumes.h), light of suns between their points (relight_volumes.h). Bricks that
/// do not exist are skipped; within the others steps of equal length h <= options.step voxels, cut
/// at the faces of bricks, take the coefficients at their midpoints as constant: with c the
/// extinction and b the scattering times J plus the own light of volumes, which needs no density,
///
///     L += T (b / c) (1 - exp(-c h)),   T *= exp(-c h),   for c = 0: L += T b h.
///
/// Any finite ray gives finite values that are not negative; where begin >= end or the direction is
/// zero, nothing. Costs at most 3 + 14 / step evaluations per brick that the ray crosses.
MarchResult march_volumes(const LitVolumes& volumes, const MarchRay& ray,
                          const MarchOptions& options = {});

/// The part of a ray where a march may see something.
struct MarchSpan {
    double begin = 0;  ///< where it enters the first table of bricks; its end if it meets none
    double end = 0;    ///< where it leaves the last one; its beginning if it meets none
};
MarchSpan volumes_span(const LitVolumes& volumes, const MarchRay& ray);

}  // namespace opaline::runtime
