#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string_view>
#include <vector>

#include "bake/reference/reference_scene.h"

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

}  // namespace opaline::bake
