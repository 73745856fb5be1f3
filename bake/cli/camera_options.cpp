#include "bake/cli/camera_options.h"

#include <cmath>
#include <cstdio>
#include <numbers>

#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/software_renderer.h"

namespace opaline::cli {

using formats::Result;

namespace {

constexpr std::uint32_t kMostPixels = runtime::kMaxPictureSize;  // along one side

void parse_size(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    const std::size_t cross = std::min(text.find('x'), text.size());
    std::string w = text.substr(0, cross), h = text.substr(std::min(cross + 1, text.size()));
    const CLI::Validator pixels = whole_number(1, kMostPixels);
    if (!pixels(w).empty() || !pixels(h).empty()) {
        refuse_usage("--size",
                     "'" + shorten(text) + "' is not WIDTHxHEIGHT in pixels, each from 1 to " +
                         std::to_string(kMostPixels),
                     "give for example 960x720");
    }
    width = static_cast<std::uint32_t>(std::stoul(w));
    height = static_cast<std::uint32_t>(std::stoul(h));
}

// Angles and distance that are not given stay those of the framing camera: `from` its target to its
// eye.
void place_by_angles(const CameraOptions& options, formats::Vec3 from, runtime::Camera& camera) {
    constexpr double kDegrees = 180 / std::numbers::pi;
    const double x = static_cast<double>(from.x), y = static_cast<double>(from.y),
                 z = static_cast<double>(from.z);
    const double azimuth = options.azimuth.value_or(std::atan2(x, z) * kDegrees);
    const double elevation = options.elevation.value_or(std::atan2(y, std::hypot(x, z)) * kDegrees);
    const auto distance = static_cast<float>(options.distance.value_or(std::hypot(x, y, z)));
    camera.eye = camera.target + distance * runtime::view_direction(azimuth, elevation);
}

}  // namespace

bool frames_object(const CameraOptions& options) {
    return options.eye.empty() && options.target.empty() && options.up.empty() &&
           !options.azimuth && !options.elevation && !options.distance;
}

void add_camera_options(CLI::App& command, CameraOptions& options) {
    command.add_option("--size", options.size, "of the picture, in pixels")
        ->option_text("WxH [" + options.size + "]");
    CLI::Option* const eye =
        command.add_option("--eye", options.eye, "camera position [m]; default: frames everything")
            ->option_text("X,Y,Z");
    command
        .add_option("--azimuth", options.azimuth,
                    "from the target to the camera, from +Z toward +X [degrees]")
        ->check(real_number(-1e6, 1e6))
        ->excludes(eye)
        ->option_text("DEG");
    command
        .add_option("--elevation", options.elevation,
                    "from the target to the camera, above the horizon [degrees]")
        ->check(real_number(-90, 90))
        ->excludes(eye)
        ->option_text("DEG");
    command.add_option("--distance", options.distance, "from the target to the camera [m]")
        ->check(number_above(0, 1e12))
        ->excludes(eye)
        ->option_text("M");
    command.add_option("--target", options.target, "point looked at [m]; default: the middle")
        ->option_text("X,Y,Z");
    command.add_option("--up", options.up, "direction that is up in the picture")
        ->option_text("X,Y,Z [0,1,0]");
    command.add_option("--fov", options.fov, "vertical angle of view [degrees]")
        ->check(number_above(0, 179.9))
        ->option_text("DEG [32]");
}

runtime::Camera make_camera(const CameraOptions& options, const formats::AssetView& view) {
    std::uint32_t width = 0, height = 0;
    parse_size(options.size, width, height);
    runtime::Camera camera = runtime::frame_asset(view, options.fov, width, height);
    const formats::Vec3 framing = camera.eye - camera.target;
    if (!options.target.empty()) {
        camera.target = parse_vec3("--target", options.target);
    }
    if (options.azimuth || options.elevation || options.distance) {
        place_by_angles(options, framing, camera);
    }
    if (!options.eye.empty()) {
        camera.eye = parse_vec3("--eye", options.eye);
    }
    if (!options.up.empty()) {
        const auto up = parse_vec3("--up", options.up);
        if (formats::length(up) == 0) {
            refuse_usage("--up", "is no direction", "give for example 0,1,0");
        }
        camera.up = up;
    }
    if (formats::length(camera.target - camera.eye) == 0) {
        refuse_usage("--eye", "lies in the target",
                     "move one of them: the camera has no direction");
    }
    if (!frames_object(options)) {
        camera.near_plane = runtime::near_plane_for(view, camera.eye);
    }
    require(runtime::check_camera(camera, runtime::SoftwareOptions{}.supersampling));
    return camera;
}

}  // namespace opaline::cli
