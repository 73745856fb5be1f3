#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "bake/accuracy/volumes/volume_probes.h"
#include "bake/base/context.h"
#include "bake/reference/estimate.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Luminance along the rays of all probes by path tracing of light of some terms, by default what
/// volumes alone scattered, once or more often: place * probes + probe. The first channel counts;
/// its variance is that of the luminance. Of TermSet::interreflection what volumes scattered last.
struct VolumeTruth {
    std::vector<Moments> luminance;
    std::uint32_t samples = 0;  ///< for each ray
    std::uint64_t events = 0;   ///< scatterings and surfaces met, of all paths
    /// Transmitted light along the rays of LightPlace::around (see_through.h), by probe.
    std::vector<double> through;
};

/// Traces until `is_enough` or until `max_events` are used up, as far as whole rounds allow; rounds
/// double the samples. The same bits for any number of threads. Errors: interrupted.
formats::Result<VolumeTruth> trace_volume_truth(
    const ReferenceScene& reference, std::span<const VolumeProbe> probes, std::uint64_t seed,
    std::uint64_t max_events, const std::function<bool(const VolumeTruth&)>& is_enough,
    const Context& context, TermSet terms = TermSet::volume_single | TermSet::volume_multiple);

}  // namespace opaline::bake
