#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "formats/opal/asset.h"
#include "formats/opal/result.h"
#include "runtime/picture/camera.h"

namespace opaline::cli {

/// What `render` and `reference` have in common.
struct CameraOptions {
    std::string size = "960x720", eye, target;
    std::optional<double> azimuth, elevation, distance;  ///< [degrees], [degrees], [m]
    float fov = 32;
};

void add_camera_options(CLI::App& command, CameraOptions& options);

/// The camera asked for; what is not asked for frames the object. Errors: usage.
formats::Result<runtime::Camera> make_camera(const CameraOptions& options,
                                             const formats::AssetView& view);

}  // namespace opaline::cli
