#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bake/accuracy/volumes/volume_truth.h"
#include "bake/base/context.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

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

}  // namespace opaline::bake
