#include "bake/environment/builtin_environment.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "bake/environment/procedural.h"

namespace opaline::bake {
namespace {

using formats::Environment;
using formats::Error;
using formats::ErrorKind;
using formats::LoadedEnvironment;
using formats::Result;
using formats::Vec3;

constexpr std::string_view kForms =
    "use white, black, sun:AZ,EL, studio, sky:TURBIDITY,EL, or the path of a lat-long .exr or .hdr";

std::string_view name_of(std::string_view spec) {
    return spec.substr(0, spec.find(':'));
}

Error bad_spec(std::string_view spec, std::string fault) {
    return formats::make_error(ErrorKind::usage, std::string(spec), "", std::move(fault),
                               std::string(kForms));
}

struct Pair {
    double first = 0, second = 0;
};

/// The two numbers after the colon; nothing if there are not exactly two finite ones.
std::optional<Pair> parse_pair(std::string_view spec) {
    const std::size_t colon = spec.find(':'), comma = spec.find(',');
    if (colon == std::string_view::npos || comma == std::string_view::npos || comma < colon) {
        return std::nullopt;
    }
    const auto parse = [](std::string_view text, double& value) {
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        return error == std::errc() && end == text.data() + text.size() && std::isfinite(value);
    };
    Pair pair;
    if (!parse(spec.substr(colon + 1, comma - colon - 1), pair.first) ||
        !parse(spec.substr(comma + 1), pair.second)) {
        return std::nullopt;
    }
    return pair;
}

Environment make_white() {
    Environment environment;
    environment.width = 2;
    environment.height = 1;
    environment.pixel.assign(2, {1, 1, 1});
    return environment;
}

Environment make_sun(double azimuth, double elevation) {
    const auto radius = static_cast<float>(0.265 * std::numbers::pi / 180);
    const auto radiance = static_cast<float>(std::numbers::pi / formats::disc_solid_angle(radius));
    Environment environment;
    environment.discs.push_back(
        {direction_of(azimuth, elevation), radius, {radiance, radiance, radiance}});
    return environment;
}

}  // namespace

Vec3 direction_of(double azimuth_degrees, double elevation_degrees) {
    const double azimuth = std::remainder(azimuth_degrees, 360.0) * std::numbers::pi / 180;
    const double elevation = elevation_degrees * std::numbers::pi / 180;
    return {static_cast<float>(std::cos(elevation) * std::sin(azimuth)),
            static_cast<float>(std::sin(elevation)),
            static_cast<float>(std::cos(elevation) * std::cos(azimuth))};
}

bool is_builtin(std::string_view spec) {
    const std::string_view name = name_of(spec);
    return name == "white" || name == "black" || name == "sun" || name == "studio" || name == "sky";
}

Result<Environment> make_environment(std::string_view spec) {
    if (spec == "white") return make_white();
    if (spec == "black") return Environment{};
    if (spec == "studio") return make_studio();
    const std::string_view name = name_of(spec);
    const std::optional<Pair> pair = parse_pair(spec);
    if (name == "sun") {
        if (!pair || std::abs(pair->second) > 90) {
            return bad_spec(spec,
                            "is not sun:AZ,EL with an azimuth and an elevation in [-90, 90], both "
                            "in degrees");
        }
        return make_sun(pair->first, pair->second);
    }
    if (name == "sky") {
        if (!pair || pair->first < 1.7 || pair->first > 10 || pair->second <= 0 ||
            pair->second > 90) {
            return bad_spec(
                spec,
                "is not sky:TURBIDITY,EL with a turbidity in [1.7, 10] and an elevation "
                "in (0, 90] degrees");
        }
        return make_sky(pair->first, pair->second, kSkyAzimuthDegrees);
    }
    return bad_spec(spec, is_builtin(spec) ? "takes no values" : "is not a built-in light");
}

Result<LoadedEnvironment> open_environment(std::string_view spec_or_path) {
    if (!is_builtin(spec_or_path)) {
        const std::filesystem::path path(spec_or_path);
        std::error_code ignored;
        if (!std::filesystem::exists(path, ignored)) {
            return formats::make_error(ErrorKind::bad_input, path.string(), "",
                                       "is neither a file nor a built-in light",
                                       std::string(kForms));
        }
        return formats::load_environment(path);
    }
    Result<Environment> made = make_environment(spec_or_path);
    if (!made) return std::move(made).error();
    return LoadedEnvironment{std::move(*made), {}};
}

std::string list_builtin_environments() {
    return "white              radiance 1 from everywhere\n"
           "black              no light: the scene's own lights and glowing surfaces alone\n"
           "sun:AZ,EL          the sun alone, 0.53 degrees across, irradiance pi; degrees: "
           "azimuth\n"
           "                   0 is +Z (the front of a model), 90 is +X; elevation above the "
           "horizon\n"
           "studio             soft boxes: warm key, weak fill, cool rim lights, dim backdrop\n"
           "sky:TURBIDITY,EL   clear sky and sun; turbidity 1.7 (very clear) to 10 (hazy), "
           "elevation\n"
           "                   of the sun above 0 to 90 degrees, azimuth -40\n";
}

}  // namespace opaline::bake
