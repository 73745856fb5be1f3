#include "bake/cli/picture_options.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <string_view>

#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "formats/opal/terms.h"
#include "runtime/picture/picture.h"
#include "runtime/picture/software_renderer.h"

namespace opaline::cli {
namespace {

constexpr const char* kOption = "--emitter";

formats::Error refuse_emitter(const std::string& text, std::string fault, std::string remedy) {
    return formats::make_error(formats::ErrorKind::usage, "", std::string(kOption) + " " + text,
                               std::move(fault), std::move(remedy));
}

// "R,G,B" or "V".
std::optional<formats::Rgb> parse_color(std::string_view text) {
    std::array<float, 3> value{};
    std::size_t count = 0;
    for (bool is_last = false; !is_last; ++count) {
        const std::size_t comma = text.find(',');
        is_last = comma == std::string_view::npos;
        const auto number = parse_number(text.substr(0, comma));
        constexpr double kMost = std::numeric_limits<float>::max();
        if (count == value.size() || !number || !(*number >= 0 && *number <= kMost)) return {};
        value[count] = static_cast<float>(*number);
        if (!is_last) text.remove_prefix(comma + 1);
    }
    if (count == 1) return formats::Rgb{value[0], value[0], value[0]};
    if (count == 3) return formats::Rgb{value[0], value[1], value[2]};
    return {};
}

}  // namespace

using formats::Result;

namespace {

constexpr std::uint32_t kMostPixels = runtime::kMaxPictureSize;  // along one side

void parse_size(const std::string& text, std::uint32_t& width, std::uint32_t& height) {
    const std::size_t cross = std::min(text.find('x'), text.size());
    const auto columns = parse_whole_number(text.substr(0, cross), 1, kMostPixels);
    const auto rows =
        parse_whole_number(text.substr(std::min(cross + 1, text.size())), 1, kMostPixels);
    if (!columns || !rows) {
        refuse_usage("--size",
                     "'" + shorten(text) + "' is not WIDTHxHEIGHT in pixels, each from 1 to " +
                         std::to_string(kMostPixels),
                     "give for example 960x720");
    }
    width = static_cast<std::uint32_t>(*columns);
    height = static_cast<std::uint32_t>(*rows);
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

void add_camera_options(const Command& command, CameraOptions& options) {
    command.add("--size", "WxH [" + options.size + "]", text(options.size),
                "of the picture, in pixels");
    const Option eye = command.add("--eye", "X,Y,Z", text(options.eye),
                                   "camera position [m]; default: frames everything");
    command
        .add("--azimuth", "DEG", real_number(options.azimuth, -1e6, 1e6),
             "from the target to the camera, from +Z toward +X [degrees]")
        .excludes(eye);
    command
        .add("--elevation", "DEG", real_number(options.elevation, -90, 90),
             "from the target to the camera, above the horizon [degrees]")
        .excludes(eye);
    command
        .add("--distance", "M", number_above(options.distance, 0, 1e12),
             "from the target to the camera [m]")
        .excludes(eye);
    command.add("--target", "X,Y,Z", text(options.target),
                "point looked at [m]; default: the middle");
    command.add("--up", "X,Y,Z [0,1,0]", text(options.up), "direction that is up in the picture");
    command.add("--fov", "DEG [32]", number_above(options.fov, 0, 179.9),
                "vertical angle of view [degrees]");
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

void add_rotate_light_option(const Command& command, double& degrees) {
    command.add("--rotate-light", "DEG [0]", real_number(degrees, -1e6, 1e6),
                "turn the light about +Y, from +Z toward +X [degrees]");
}

void add_exposure_option(const Command& command, std::optional<float>& exposure,
                         const char* otherwise) {
    command.add("--exposure", "EV", real_number(exposure, -64, 64),
                std::string("brighter by a factor of 2^EV; default: ") + otherwise);
}

void add_look_options(const Command& command, const LookOptions& options) {
    add_rotate_light_option(command, options.rotate_light);
    command.add("--terms", "all|LIST [all]", term_list(options.terms),
                "components to show: all, or some of " +
                    formats::term_names(formats::TermSet::baked) +
                    "; the background is black, without a cloud layer, unless all are. " +
                    formats::term_names(formats::TermSet::separable, " and ") +
                    " apart need a bake with --separate-terms");
    add_exposure_option(command, options.exposure,
                        "0, but lower where what is shown is too bright for a screen, and higher "
                        "where it is nearly black; 0 of .exr");
    command.add("--tone-map",
                one_of(options.tone_map,
                       {{"neutral", runtime::ToneMap::neutral}, {"none", runtime::ToneMap::none}}),
                "of screens and .png. neutral: as Khronos PBR Neutral up to its shoulder, above it "
                "each band by itself; none: cut off at 1");
    command.add("--coefficients", "M [all]", whole_number(options.coefficients, 6, 1U << 20U),
                "use at most M coefficients of a row of a mesh, the largest: what a bake with "
                "fewer looks like");
}

void add_emitter_option(const Command& command, std::vector<std::string>& given) {
    command.add(kOption, "NAME=R,G,B", texts(given),
                "multiply the light of an emitter of the file, which `opaline info` lists, by R, G "
                "and B; 0,0,0 switches it off. May be given for several emitters");
}

formats::Result<std::vector<formats::Rgb>> parse_emitters(const formats::EmittersView& emitters,
                                                          const std::vector<std::string>& texts) {
    std::vector<formats::Rgb> colors(emitters.size(), {1, 1, 1});
    for (const std::string& text : texts) {
        const std::size_t equals = text.rfind('=');  // names may have one
        if (equals == std::string::npos) {
            return refuse_emitter(text, "expected NAME=R,G,B", "give a name and three factors");
        }
        const std::uint32_t emitter =
            find_emitter(emitters, std::string_view(text).substr(0, equals));
        if (emitter == emitters.size()) {
            return refuse_emitter(text, "the file has no emitter of that name",
                                  emitters.empty() ? "it has none at all: bake a scene with lamps"
                                                   : "it has " + list_emitters(emitters));
        }
        const auto color = parse_color(std::string_view(text).substr(equals + 1));
        if (!color) {
            return refuse_emitter(text, "expected three numbers, finite and not negative",
                                  "give factors such as 1,0.8,0.5, or one for all bands");
        }
        colors[emitter] = *color;
    }
    return colors;
}

}  // namespace opaline::cli
