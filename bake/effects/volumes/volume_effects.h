#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace opaline::bake {

/// How light that was scattered more than once is found; the order of the knob's words.
enum class VolumeMethod : std::uint8_t {
    automatic,         ///< by counted work and measured error
    path_integration,  ///< quasi-most-probable paths: no noise, an error of the model
    walks              ///< random walks: noise, no error of the model
};

inline constexpr std::array<std::string_view, 3> kVolumeMethodWords{"auto", "path-integration",
                                                                    "walks"};

constexpr std::string_view name_of(VolumeMethod method) {
    return kVolumeMethodWords[static_cast<std::size_t>(method)];
}

/// Effects of volumes, as plans, --effects and reports name them.
inline constexpr std::string_view kOnceInVolumes = "volume-single";
inline constexpr std::string_view kOftenInVolumes = "volume-multiple";
inline constexpr std::string_view kVolumesToSurfaces = "volume-surface";
inline constexpr std::string_view kSurfacesToVolumes = "surface-volume";
/// A volume that glows is an emitter.
inline constexpr std::string_view kEmitters = "emitters";

}  // namespace opaline::bake
