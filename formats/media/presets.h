#pragma once

#include <optional>
#include <span>
#include <string_view>

#include "formats/scene.h"

namespace opaline::formats {

/// A medium measured in [Jensen2001]: sigma_s' and sigma_a [1/m]. Only reduced scattering was
/// measured: the phase function is isotropic and sigma_s = sigma_s'. eta is 1.5 for marble and 1.3
/// for all others. Nothing where no preset has this name.
std::optional<Medium> media_preset(std::string_view name);

/// The names, sorted, for help and messages. Beside them `skimmilk` is understood.
std::span<const std::string_view> media_preset_names();

}  // namespace opaline::formats
