#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "bake/cli/command.h"
#include "formats/opal/asset.h"
#include "formats/opal/emitters.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"
#include "runtime/emitter_light.h"
#include "runtime/picture/camera.h"
#include "runtime/picture/tone_map.h"

namespace opaline::cli {

/// `--emitter NAME=R,G,B`, or NAME=V for a grey factor; may be given often.
void add_emitter_option(const Command& command, std::vector<std::string>& texts);

/// A factor for each emitter of a file: 1 where none is given, the last one where several are.
/// Errors: usage, for a name that the file does not have, and for factors that are not finite or
/// below 0.
formats::Result<std::vector<formats::Rgb>> parse_emitters(const formats::EmittersView& emitters,
                                                          const std::vector<std::string>& texts);

/// What `render` and `view` share besides the camera: where their options are put.
struct LookOptions {
    double& rotate_light;  ///< [degrees]
    std::string& terms;
    std::optional<float>& exposure;  ///< [EV]; nothing: chosen from the picture
    runtime::ToneMap& tone_map;
    std::optional<std::uint32_t>& coefficients;  ///< of a row
};

/// Those that other commands have as well; `otherwise`: what is without the option.
void add_rotate_light_option(const Command& command, double& degrees);
void add_exposure_option(const Command& command, std::optional<float>& exposure,
                         const char* otherwise);

void add_look_options(const Command& command, const LookOptions& options);

/// Options common to `render` and `reference`.
struct CameraOptions {
    std::string size = "960x720", eye, target, up;
    std::optional<double> azimuth, elevation, distance;  ///< [degrees], [degrees], [m]
    float fov = 32;
};

void add_camera_options(const Command& command, CameraOptions& options);

/// Whether no option places the camera, so that it frames the object.
bool frames_object(const CameraOptions& options);

/// The requested camera; missing parts are chosen to frame the object. Errors: usage.
runtime::Camera make_camera(const CameraOptions& options, const formats::AssetView& view);

}  // namespace opaline::cli
