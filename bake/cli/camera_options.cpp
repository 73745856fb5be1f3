#include "bake/cli/camera_options.h"

#include <cstdio>

#include "bake/cli/inputs.h"
#include "runtime/picture/software_renderer.h"

namespace opaline::cli {

using formats::ErrorKind;
using formats::make_error;
using formats::Result;
using formats::Status;

namespace {

Status parse_size(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    int used = 0;
    if (std::sscanf(text.c_str(), "%5ux%5u%n", &width, &height, &used) != 2 ||
        static_cast<std::size_t>(used) != text.size() || width == 0 || height == 0) {
        return make_error(ErrorKind::usage, "", "--size", "'" + text + "' is not a size",
                          "give WIDTHxHEIGHT in pixels, such as 960x720");
    }
    return formats::ok_status();
}

}  // namespace

void add_camera_options(CLI::App& command, CameraOptions& options) {
    command.add_option("--size", options.size, "of the picture, in pixels")
        ->option_text("WxH [960x720]");
    command.add_option("--eye", options.eye, "camera position [m]; default: frames the object")
        ->option_text("X,Y,Z");
    command.add_option("--target", options.target, "point looked at [m]; default: the object")
        ->option_text("X,Y,Z");
    command.add_option("--fov", options.fov, "vertical angle of view [degrees]")
        ->option_text("DEG [32]");
}

Result<runtime::Camera> make_camera(const CameraOptions& options, const formats::AssetView& view) {
    std::uint32_t width = 0, height = 0;
    if (auto status = parse_size(options.size, width, height); !status) {
        return status.error();
    }
    runtime::Camera camera = runtime::frame_asset(view, options.fov, width, height);
    if (!options.target.empty()) {
        const auto target = parse_vec3("--target", options.target);
        if (!target) {
            return target.error();
        }
        camera.target = *target;
    }
    if (!options.eye.empty()) {
        const auto eye = parse_vec3("--eye", options.eye);
        if (!eye) {
            return eye.error();
        }
        camera.eye = *eye;
    }
    if (formats::length(camera.target - camera.eye) == 0) {
        return make_error(ErrorKind::usage, "", "--eye", "lies in the target",
                          "move one of them: the camera has no direction");
    }
    if (!options.eye.empty() || !options.target.empty()) {
        camera.near_plane = runtime::near_plane_for(view, camera.eye);
    }
    if (auto status = runtime::check_camera(camera, runtime::SoftwareOptions{}.supersampling);
        !status) {
        return status.error();
    }
    return camera;
}

}  // namespace opaline::cli
