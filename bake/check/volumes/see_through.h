#pragma once

#include <span>
#include <vector>

#include "bake/check/volumes/volume_probes.h"
#include "formats/opal/volumes.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Luminance of even light of radiance 1 behind everything that passes through the volumes along
/// each probe's ray of LightPlace::around; 0 where a surface ends it. Of the scene: e^-(optical
/// depth), by the midpoint rule in steps of a quarter of a voxel.
std::vector<double> see_through_scene(std::span<const formats::Volume> volumes,
                                      std::span<const VolumeProbe> probes);

/// The same of a finished file, by the runtime's march. `n`, `origin`, `threads`: as march_probes.
std::vector<double> see_through_file(const formats::VolumesView& volumes, std::uint32_t n,
                                     glm::dvec3 origin, std::span<const VolumeProbe> probes,
                                     unsigned threads);

}  // namespace opaline::bake
