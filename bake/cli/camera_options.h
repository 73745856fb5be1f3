#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::cli {

/// Options common to `render` and `reference`.
struct CameraOptions {
    std::string size = "960x720", eye, target, up;
    std::optional<double> azimuth, elevation, distance;  ///< [degrees], [degrees], [m]
    float fov = 32;
};

void add_camera_options(CLI::App& command, CameraOptions& options);

/// Whether no option places the camera, so that it frames the object.
bool frames_object(const CameraOptions& options);

/// The requested camera; missing parts are chosen to frame the object. Errors: usage.
runtime::Camera make_camera(const CameraOptions& options, const formats::AssetView& view);

}  // namespace opaline::cli
