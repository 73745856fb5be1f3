#pragma once

#include <string>
#include <string_view>

#include "formats/image/load_environment.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Azimuth of the sun of `sky:`: light comes over the left shoulder of a camera on the +Z side.
inline constexpr double kSkyAzimuthDegrees = -40.0;

/// Unit direction of an azimuth (0 = +Z, the front of a glTF model; 90 = +X) and an elevation
/// above the horizon, both in degrees.
formats::Vec3 direction_of(double azimuth_degrees, double elevation_degrees);

/// True if the text names a built-in light, well-formed or not: the part before ':' is one of
/// white, black, sun, studio, sky. (A file of that name is opened as "./white".)
bool is_builtin(std::string_view spec);

/// Makes a built-in light:
/// - `white`: radiance 1 from everywhere;
/// - `black`: none, for scenes that have light of their own;
/// - `sun:AZ,EL`: a disc 0.53 degrees across over black, integral of its radiance over solid angle
///   pi, so that a white diffuse surface facing it has radiance 1; EL in [-90, 90];
/// - `studio`: soft boxes in a dim room, see make_studio;
/// - `sky:TURBIDITY,EL`: clear sky and sun, see make_sky; turbidity in [1.7, 10], EL in (0, 90].
/// Errors: usage, with the valid forms in the remedy.
formats::Result<formats::Environment> make_environment(std::string_view spec);

/// A built-in light if `is_builtin`, else the file of that name.
/// Errors: as make_environment and formats::load_environment.
formats::Result<formats::LoadedEnvironment> open_environment(std::string_view spec_or_path);

/// One line per built-in light, for help texts.
std::string list_builtin_environments();

}  // namespace opaline::bake
