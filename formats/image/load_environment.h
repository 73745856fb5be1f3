#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/environment.h"
#include "formats/opal/result.h"

namespace opaline::formats {

struct LoadedEnvironment {
    Environment environment;           ///< finite, 0 <= radiance <= kMaxRadiance
    std::vector<Diagnostic> warnings;  ///< what was repaired or assumed, one entry per kind
};

/// Largest radiance of a loaded map, so that sums over all its texels stay finite in float.
inline constexpr float kMaxRadiance = 1e30f;

/// Loads distant lighting from an OpenEXR or Radiance file, told apart by content.
/// - `envmap` attribute of OpenEXR: honoured, lat-long or cube. A cube of that convention has its
///   outer texel centres on the cube's edges and is resampled to ours (bilinear).
/// - six times as high as wide, or as wide as high: a cube, faces +X -X +Y -Y +Z -Z in OpenGL
///   orientation.
/// - else a lat-long map with +X in the centre; a warning if it is not twice as wide as high.
/// NaN and negative values become 0, infinite ones the largest finite value of the map
/// (kMaxRadiance at most); each is counted in a warning, negative ones if they sum up to more than
/// a thousandth of all light. Errors: bad_input.
Result<LoadedEnvironment> load_environment(const std::filesystem::path& path);

/// The same from memory; `name` is used in messages only.
Result<LoadedEnvironment> decode_environment(std::span<const std::byte> bytes,
                                             const std::string& name);

}  // namespace opaline::formats
