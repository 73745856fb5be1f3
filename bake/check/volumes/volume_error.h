#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/check/volumes/volume_probes.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"
#include "runtime/emitter_light.h"

namespace opaline::bake {

/// Luminance [W m^-2 sr^-1] that a finished file's volumes scatter along the rays of all probes,
/// by the runtime's own functions: value[place * probes + probe]. `origin` moves the scene's frame
/// to the world; `n`: texels along an edge of the file's cube map. The same bits for any number of
/// `threads` (0: all cores).
std::vector<double> march_probes(const formats::VolumesView& volumes, std::uint32_t n,
                                 glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                 unsigned threads);

/// Luminance of the light that volumes send out by themselves, seen directly or scattered, along
/// the same rays, in the same order. `emitters`: with their light; none: all, as they are.
std::vector<double> march_glow(const formats::VolumesView& volumes, glm::dvec3 origin,
                               std::span<const VolumeProbe> probes, unsigned threads,
                               const runtime::EmitterLight& emitters = {});

/// Error of a finished file's volumes: luminance that they scatter, and let pass, along rays, by
/// the runtime's march, against path tracing. Model and numbers err together. The noise of the
/// paths is subtracted.
struct VolumeErrorReport {
    /// RMS of the error over that of the truth; in squares the mean of the parts.
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< bootstrap over probes, with two more that err as the worst does
    std::uint32_t rays_checked = 0;
    std::uint64_t samples = 0;  ///< paths traced, of all rays
    std::uint64_t events = 0;   ///< scatterings and surfaces that they met
    std::string reference;      ///< the reference, in words
    /// Under lights of one LightPlace, relative to the RMS of the truth under these, or to a tenth
    /// of that under even light where this is more.
    struct Part {
        std::string name;
        double rms_relative = 0;
        double ci95[2] = {0, 0};
        double bias = 0;   ///< mean difference over mean truth; > 0: the file is too bright
        double noise = 0;  ///< RMS standard error of the truth
        /// RMS of the error without the light that passes through; as rms_relative under suns.
        double scattered_alone = 0;
    };
    std::vector<Part> by_light;  ///< in the order of LightPlace; empty: nothing was checked
};

/// Effort of the check. It counts events, not seconds, so that the result does not depend on the
/// machine.
struct VolumeCheckOptions {
    std::uint32_t probes = 32;
    std::uint64_t seed = 0;
    double noise = 0.01;                 ///< relative to the truth: enough for any file
    double noise_share = 0.5;            ///< relative to the difference: enough for this file
    std::uint64_t max_events = 1000000;  ///< scatterings and surfaces met, of all rays
    bool sees_surfaces = false;          ///< the file holds light that surfaces send to volumes
};

/// Errors of `luminance` (march_probes) against a truth of the same probes. Under even light what
/// passes through, `through` (see_through_file), counts on both sides, but not in the RMS of the
/// truth (README.md, "Even light"); empty: it is the same on both.
VolumeErrorReport compare_volumes(std::span<const double> luminance,
                                  std::span<const double> through, const VolumeTruth& truth,
                                  std::uint64_t seed);

/// Compares the volumes of `asset`, baked from `scene`, with path tracing. Light that reaches the
/// eye from surfaces is on neither side, nor, but with VolumeCheckOptions::sees_surfaces, what
/// these send to volumes; unscattered light is on both under even light. The same bits for any
/// number of threads. Errors: resource, interrupted.
formats::Result<VolumeErrorReport> check_volumes(const formats::Scene& scene,
                                                 const formats::AssetView& asset,
                                                 const VolumeCheckOptions& options,
                                                 const Context& context);

/// Error of the light that volumes send out by themselves: luminance along rays, seen directly and
/// scattered, by the runtime's march, against path tracing.
struct GlowErrorReport {
    double rms_relative = 0;         ///< RMS of the error over that of the truth, noise subtracted
    double bias = 0;                 ///< mean difference over mean truth
    double noise = 0;                ///< RMS standard error of the truth over its RMS
    std::uint32_t rays_checked = 0;  ///< 0: nothing was checked
    std::uint64_t events = 0;        ///< of all paths
};

/// What volumes scatter of the light of lamps: those emitters from `first` on. Surfaces reflect it
/// on the side of the paths as often as it may be.
formats::Result<GlowErrorReport> check_lamps(const formats::Scene& scene,
                                             const formats::AssetView& asset, std::uint32_t first,
                                             const VolumeCheckOptions& options,
                                             const Context& context);

/// The volumes of `asset`, baked from `scene`, through the rays of its check (check_volumes).
/// Surfaces are black on both sides. The same bits for any number of threads. Errors: resource,
/// interrupted.
formats::Result<GlowErrorReport> check_glow(const formats::Scene& scene,
                                            const formats::AssetView& asset,
                                            const VolumeCheckOptions& options,
                                            const Context& context);

}  // namespace opaline::bake
