#pragma once

#include <vector>

#include "bake/accuracy/volumes/volume_probes.h"
#include "formats/opal/environment.h"

namespace opaline::bake {

/// A sun as large as ours, whose light facing it is pi [W m^-2]: a white surface reflects 1.
formats::Environment make_probe_sun(glm::vec3 direction);

/// Radiance 1 [W m^-2 sr^-1] from all directions.
formats::Environment make_even_light();

/// The lights of all probes: the sun of each, then the even light.
std::vector<formats::Environment> make_volume_lights(std::span<const VolumeProbe> probes);

/// Number in that list of the light that a probe's ray is seen under.
inline std::size_t light_number(std::size_t probe, std::size_t probes, std::size_t place) {
    return place == static_cast<std::size_t>(LightPlace::around) ? probes : probe;
}

}  // namespace opaline::bake
