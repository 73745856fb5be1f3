#pragma once

#include <string_view>

namespace opaline::bake {

/// Effects of volumes, as plans, --effects and reports name them.
inline constexpr std::string_view kOnceInVolumes = "volume-single";
inline constexpr std::string_view kOftenInVolumes = "volume-multiple";
inline constexpr std::string_view kVolumesToSurfaces = "volume-surface";
inline constexpr std::string_view kSurfacesToVolumes = "surface-volume";
/// A volume that glows is an emitter.
inline constexpr std::string_view kEmitters = "emitters";

}  // namespace opaline::bake
