#pragma once

#include <array>
#include <span>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/check/model_truth.h"
#include "bake/check/volumes/volume_error.h"
#include "formats/opal/asset.h"

namespace opaline::bake {

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
