#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/check/model_pairs.h"
#include "bake/check/volumes/volume_error.h"
#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "runtime/light_vector.h"

namespace opaline::bake {

/// The test lights in one resolution, grey: luminance in all three bands.
struct ProbeLights {
    std::vector<std::string> names;
    std::vector<runtime::LightVector> vectors;
};
/// The published ones (measure/test_lights.h) for a cube map of n x n texels.
formats::Result<ProbeLights> make_probe_lights(std::uint32_t n, unsigned threads);

/// Receivers at which the points of a sweep are compared, ascending: all, or `most` of them, one at
/// an irregular position in each of `most` equal runs.
std::vector<std::uint32_t> choose_probes(std::size_t receivers, std::size_t most);

/// Relit luminance at the probes: value[probe * lights + light]. Without base colour, and of media
/// along the normal without the Fresnel factor, as a bake's self-check has it.
std::vector<double> relight_probes(const formats::AssetView& asset,
                                   std::span<const std::uint32_t> probes,
                                   const ProbeLights& lights);

/// How far `luminance` is from `truth`, both from relight_probes of the same scene: as a whole, by
/// what fills the probes' rows (`effect`: of each, "multiple+single"), and by light.
ErrorReport compare_probes(std::span<const double> luminance, std::span<const double> truth,
                           std::span<const std::string> effect,
                           std::span<const std::string> lights);

/// Adds the truth's own error in quadrature to an error against it, to the upper end of its
/// interval, and to the common effects and lights. The lower end stays, because correlated errors
/// may cancel.
void add_error_of_truth(ErrorReport& error, const ErrorReport& truth);

/// RMS of the difference over RMS of the truth; 0 where the truth is black.
double relative_difference(std::span<const double> luminance, std::span<const double> truth);

/// Rays through a scene's volumes that all bakes are compared at, and path tracing along them.
struct SweepVolumes {
    std::vector<VolumeProbe> probes;
    VolumeTruth truth;
    std::array<double, kLightPlaces> scale{};  ///< 1 / RMS of the truth, by LightPlace

    bool empty() const { return probes.empty(); }
};

/// Traces for about so many seconds; a least amount is traced whatever it takes. Empty where no
/// volume is. Errors: as trace_volume_truth.
formats::Result<SweepVolumes> make_sweep_volumes(const formats::Scene& scene, double seconds,
                                                 std::uint64_t seed, const Context& context);

/// Luminance along the rays, relative to the RMS of the truth under lights of the same place:
/// value[probe * kLightPlaces + place].
std::vector<double> relative_luminance(const SweepVolumes& volumes,
                                       std::span<const double> marched);

/// The names of the four places, as of lights.
std::vector<std::string> volume_light_names();

/// The error of volumes in the words of surfaces: rays count as receivers, places as lights.
ErrorReport as_error_report(const VolumeErrorReport& volumes);

/// A bake's error is the larger one, of surfaces or of volumes; the parts are those of both.
void take_larger(ErrorReport& error, const ErrorReport& volumes);
void take_larger(ModelErrorReport& error, const VolumeErrorReport& volumes);

}  // namespace opaline::bake
