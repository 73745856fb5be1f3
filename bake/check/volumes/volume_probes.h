#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "bake/base/context.h"
#include "bake/reference/estimate.h"
#include "bake/reference/reference_scene.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Place of a light relative to a ray from the eye. A sun is ahead within 60 degrees of the ray's
/// direction, behind the eye within 60 degrees of the opposite one, else beside it; even light
/// comes from all around.
enum class LightPlace : std::uint8_t { ahead, beside, behind, around };
inline constexpr std::size_t kLightPlaces = 4;
/// In reports: the light is seen from "forward", "side", "back" and as "even".
inline constexpr std::array<std::string_view, kLightPlaces> kLightPlaceNames{"forward", "side",
                                                                             "back", "even"};

/// A ray from the eye through volumes, in the scene's frame.
struct VolumeRay {
    glm::vec3 origin{0};     ///< [m] outside of all volumes, or in front of a surface
    glm::vec3 direction{0};  ///< unit, away from the eye
    float end = 0;           ///< [m] along it: where a surface ends it, or infinite
};

/// A point where density is, a sun, and one ray through the point for each LightPlace.
struct VolumeProbe {
    glm::vec3 sun{0};  ///< unit, toward it
    std::array<VolumeRay, kLightPlaces> ray;
};

/// Up to `count` probes. Points are drawn in proportion to extinction, suns and rays from all
/// directions: uniform within each place, and stratified by the angle between ray and sun. Points
/// inside bodies are drawn again; fewer where no others are found. `scene` is the one of which
/// `reference` was made. A pure function of its arguments.
std::vector<VolumeProbe> choose_volume_probes(const ReferenceScene& reference, std::uint32_t count,
                                              std::uint64_t seed);

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
