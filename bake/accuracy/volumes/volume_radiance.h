#pragma once

#include <span>
#include <vector>

#include "bake/accuracy/volumes/volume_probes.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {

/// Luminance [W m^-2 sr^-1] that a finished file's volumes scatter along the rays of all probes,
/// by the runtime's own functions: value[place * probes + probe]. `origin` moves the scene's frame
/// to the world; `n`: texels along an edge of the file's cube map. The same bits for any number of
/// `threads` (0: all cores).
std::vector<double> march_probes(const formats::VolumesView& volumes, std::uint32_t n,
                                 glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                 unsigned threads);

/// Luminance of the light that volumes send out by themselves, seen directly or scattered, along
/// the same rays, in the same order.
std::vector<double> march_glow(const formats::VolumesView& volumes, glm::dvec3 origin,
                               std::span<const VolumeProbe> probes, unsigned threads);

}  // namespace opaline::bake
