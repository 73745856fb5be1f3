#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/lights/builtin_environment.h"
#include "bake/lights/daylight.h"

namespace opaline::bake {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

constexpr std::uint32_t kWidth = 1024, kHeight = 512;
constexpr double kSunAngularRadius = 0.265 * std::numbers::pi / 180;

using Color = std::array<double, 3>;

Color in_gamut(const Xyz& xyz) {
    Color color = formats::rec709_of_xyz(xyz);
    for (double& band : color) {
        band = std::max(band, 0.0);
    }
    return color;
}

double luminance_of(const Color& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

Rgb to_rgb(const Color& c, double scale) {
    return {static_cast<float>(scale * c[0]), static_cast<float>(scale * c[1]),
            static_cast<float>(scale * c[2])};
}

}  // namespace

Environment make_sky(double turbidity, double elevation, double azimuth) {
    const Vec3 sun = direction_of(azimuth, elevation);
    const double sun_zenith = std::numbers::pi / 2 - elevation * std::numbers::pi / 180;
    const PerezSky perez = make_perez_sky(turbidity, sun_zenith);
    const auto sky_color = [&](double x, double y, double z) {
        const double cosine = x * double{sun.x} + y * double{sun.y} + z * double{sun.z};
        return in_gamut(eval_perez_sky(perez, y, std::acos(std::clamp(cosine, -1.0, 1.0))));
    };

    // Upper half: the sky, and the irradiance E of a horizontal surface, by rows of equal cosine.
    std::vector<Color> map(std::size_t{kWidth} * kHeight);
    const Color sunlight = in_gamut(sun_irradiance(turbidity, sun_zenith));
    Color irradiance;
    for (std::size_t band = 0; band < 3; ++band) {
        irradiance[band] = sunlight[band] * std::sin(elevation * std::numbers::pi / 180);
    }
    const auto direction_at = [](std::uint32_t row, std::uint32_t column) -> Color {
        const double theta = std::numbers::pi * (row + 0.5) / kHeight;
        const double phi = std::numbers::pi * (2 * (column + 0.5) / kWidth - 1);
        return {std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
    };
    for (std::uint32_t row = 0; row < kHeight / 2; ++row) {
        const double sin0 = std::sin(std::numbers::pi * row / kHeight),
                     sin1 = std::sin(std::numbers::pi * (row + 1) / kHeight);
        const double weight =
            std::numbers::pi / kWidth * (sin1 * sin1 - sin0 * sin0);  // integral of cos dw
        for (std::uint32_t column = 0; column < kWidth; ++column) {
            const auto [x, y, z] = direction_at(row, column);
            const Color color = sky_color(x, y, z);
            map[std::size_t{row} * kWidth + column] = color;
            for (std::size_t band = 0; band < 3; ++band) {
                irradiance[band] += weight * color[band];
            }
        }
    }

    // Lower half: a diffuse ground. It fades into the horizon over three degrees, so that
    // reflections and backgrounds show no hard line.
    const Color albedo{0.21, 0.19, 0.16};
    const double haze = std::sin(3 * std::numbers::pi / 180);
    for (std::uint32_t row = kHeight / 2; row < kHeight; ++row) {
        for (std::uint32_t column = 0; column < kWidth; ++column) {
            const auto [x, y, z] = direction_at(row, column);
            const double flat = std::hypot(x, z);
            const double t = std::clamp(-y / haze, 0.0, 1.0), far = 1 - t * t * (3 - 2 * t);
            Color color{};
            if (far > 0) color = sky_color(x / flat, 0, z / flat);
            for (std::size_t band = 0; band < 3; ++band) {
                color[band] = far * color[band] +
                              (1 - far) * albedo[band] * irradiance[band] / std::numbers::pi;
            }
            map[std::size_t{row} * kWidth + column] = color;
        }
    }

    // Scale the luminance of a horizontal white diffuse surface, E / pi, to 1.
    const double scale = std::numbers::pi / luminance_of(irradiance);
    Environment environment;
    environment.width = kWidth;
    environment.height = kHeight;
    environment.pixel.reserve(map.size());
    for (const Color& color : map) {
        environment.pixel.push_back(to_rgb(color, scale));
    }
    const auto radius = static_cast<float>(kSunAngularRadius);
    environment.discs.push_back(
        {sun, radius, to_rgb(sunlight, scale / formats::disc_solid_angle(radius))});
    return environment;
}

}  // namespace opaline::bake
