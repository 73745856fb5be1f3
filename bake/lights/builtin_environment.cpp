#include "bake/lights/builtin_environment.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace opaline::bake {
namespace {

using formats::DistantDisc;
using formats::Environment;
using formats::Error;
using formats::ErrorKind;
using formats::Image;
using formats::LoadedEnvironment;
using formats::Result;
using formats::Rgb;
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

struct Point {
    double x, y, z;
};

Point lat_long_point(double u, double v) {
    const double theta = std::numbers::pi * v, phi = std::numbers::pi * (2 * u - 1);
    return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
}

Vec3 to_vec3(Point p) {
    return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

bool is_aligned(const Environment& environment, std::uint32_t width, std::uint32_t height) {
    return environment.layout == Environment::Layout::lat_long && environment.width == width &&
           environment.height == height && environment.u_offset == 0.5f &&
           environment.u_sign == 1.0f && !environment.rows_include_poles;
}

/// Mean of the map over every pixel, each sample weighted by its solid angle.
void rasterise_map(const Environment& environment, Image& image) {
    const std::uint32_t source =
        environment.layout == Environment::Layout::cube ? 4 * environment.width : environment.width;
    const std::uint32_t k = std::clamp((2 * source + image.width - 1) / image.width, 2u, 16u);
    for (std::uint32_t row = 0; row < image.height; ++row) {
        for (std::uint32_t column = 0; column < image.width; ++column) {
            double r = 0, g = 0, b = 0, total = 0;
            for (std::uint32_t i = 0; i < k * k; ++i) {
                const double v = (row + (i / k + 0.5) / k) / image.height;
                const double u = (column + (i % k + 0.5) / k) / image.width;
                const double weight = std::sin(std::numbers::pi * v);
                const Rgb c = sample_map(environment, to_vec3(lat_long_point(u, v)));
                r += weight * double{c.r};
                g += weight * double{c.g};
                b += weight * double{c.b};
                total += weight;
            }
            image.pixel[std::size_t{row} * image.width + column] = {static_cast<float>(r / total),
                                                                    static_cast<float>(g / total),
                                                                    static_cast<float>(b / total)};
        }
    }
}

/// Adds a disc by its coverage of each pixel, then scales it to the exact flux.
void add_disc(const DistantDisc& disc, Image& image) {
    const double width = image.width, height = image.height;
    const Point center{double{disc.direction.x}, double{disc.direction.y},
                       double{disc.direction.z}};
    const double radius = double{disc.angular_radius};
    const double chord_squared = 4 * std::pow(std::sin(0.5 * radius), 2);
    const auto distance_squared = [&](Point p) {
        return std::pow(p.x - center.x, 2) + std::pow(p.y - center.y, 2) +
               std::pow(p.z - center.z, 2);
    };
    // A point of a pixel is at most half the sum of the side lengths away from its centre.
    const double reach = std::numbers::pi * (1 / width + 0.5 / height);
    const double outer = std::min(radius + reach, std::numbers::pi),
                 inner = std::max(radius - reach, 0.0);
    const double far_squared = 4 * std::pow(std::sin(0.5 * outer), 2);
    const double near_squared = 4 * std::pow(std::sin(0.5 * inner), 2);
    // Sub-pixels are an eighth of the radius apart, so that a tiny disc still covers some.
    const double pixel_size = std::numbers::pi * std::max(2 / width, 1 / height);
    const int k = static_cast<int>(std::clamp(8 * pixel_size / radius, 16.0, 2048.0));

    struct Covered {
        std::size_t pixel;
        double share;
    };
    std::vector<Covered> covered;
    double flux = 0;  // of radiance 1
    for (std::uint32_t row = 0; row < image.height; ++row) {
        const double solid_angle = lat_long_pixel_solid_angle(image.width, image.height, row);
        for (std::uint32_t column = 0; column < image.width; ++column) {
            const double middle =
                distance_squared(lat_long_point((column + 0.5) / width, (row + 0.5) / height));
            if (middle > far_squared) continue;
            double share = 1;
            if (middle >= near_squared || inner == 0) {
                double inside = 0, total = 0;
                for (int i = 0; i < k; ++i) {
                    const double v = (row + (i + 0.5) / k) / height,
                                 weight = std::sin(std::numbers::pi * v);
                    for (int j = 0; j < k; ++j) {
                        const double u = (column + (j + 0.5) / k) / width;
                        total += weight;
                        if (distance_squared(lat_long_point(u, v)) <= chord_squared) {
                            inside += weight;
                        }
                    }
                }
                share = inside / total;
            }
            if (share > 0) {
                covered.push_back({std::size_t{row} * image.width + column, share});
                flux += share * solid_angle;
            }
        }
    }
    if (covered.empty()) {  // smaller than the finest sub-pixel
        const double u = 0.5 + std::atan2(center.z, center.x) / (2 * std::numbers::pi);
        const double v = std::acos(std::clamp(center.y, -1.0, 1.0)) / std::numbers::pi;
        const auto column = std::min(static_cast<std::uint32_t>(u * width), image.width - 1);
        const auto row = std::min(static_cast<std::uint32_t>(v * height), image.height - 1);
        covered.push_back({std::size_t{row} * image.width + column, 1});
        flux = lat_long_pixel_solid_angle(image.width, image.height, row);
    }
    const double scale = formats::disc_solid_angle(disc.angular_radius) / flux;
    for (const Covered& c : covered) {
        Rgb& pixel = image.pixel[c.pixel];
        pixel = pixel + static_cast<float>(scale * c.share) * disc.radiance;
    }
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

double lat_long_pixel_solid_angle(std::uint32_t width, std::uint32_t height, std::uint32_t row) {
    // cos a - cos b as a product, which does not cancel at the poles.
    const double middle = std::numbers::pi * (row + 0.5) / height,
                 half = 0.5 * std::numbers::pi / height;
    return 2 * std::numbers::pi / width * 2 * std::sin(middle) * std::sin(half);
}

Image rasterise_lat_long(const Environment& environment, std::uint32_t width,
                         std::uint32_t height) {
    Image image{width, height, {}};
    if (is_aligned(environment, width, height) && !environment.pixel.empty()) {
        image.pixel = environment.pixel;
    } else {
        image.pixel.resize(std::size_t{width} * height);
        if (!environment.pixel.empty()) rasterise_map(environment, image);
    }
    for (const DistantDisc& disc : environment.discs) {
        add_disc(disc, image);
    }
    return image;
}

}  // namespace opaline::bake
