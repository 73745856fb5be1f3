#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "formats/image/image.h"
#include "formats/image/load_environment.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// The whole environment, discs included, as a lat-long image with +X in its centre (our
/// convention for files). Each disc is spread over the pixels it covers and scaled so that the sum
/// of radiance times exact pixel solid angle is its flux; the map is averaged over each pixel (and
/// copied where size and orientation agree). Width and height at least 1.
formats::Image rasterise_lat_long(const formats::Environment& environment, std::uint32_t width,
                                  std::uint32_t height);

/// Exact solid angle [sr] of a pixel in a row of a lat-long image; it is the same in all columns.
double lat_long_pixel_solid_angle(std::uint32_t width, std::uint32_t height, std::uint32_t row);

/// A photographer's studio for translucent statues, 1024 x 512: a large warm key light at the left
/// front, a weak broad fill at the right, two tall cool strips behind, which light thin parts from
/// the back, an overhead panel, a dim backdrop and a darker floor. Radiance at most 15, mean over
/// the sphere about 0.5; every edge is smooth.
formats::Environment make_studio();

/// Clear daylight sky with its sun as a disc, 1024 x 512, after [Preetham1999]: luminance and
/// chromaticity distribution (its appendix), sunlight through its molecules, ozone and aerosol.
/// Below the horizon lies a ground of albedo about 0.2 lit by this sky. Scaled so that a horizontal
/// white diffuse surface has luminance 1. `turbidity` in [1.7, 10], `elevation` of the sun in
/// (0, 90] degrees, `azimuth` in degrees as in direction_of.
formats::Environment make_sky(double turbidity, double elevation, double azimuth);

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
