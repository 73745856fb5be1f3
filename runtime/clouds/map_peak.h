#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <vector>

#include "formats/opal/cubemap.h"
#include "formats/opal/environment.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"
#include "runtime/map_geometry.h"

namespace opaline::runtime {

/// A map with pixels larger than 3 degrees as a lat-long map of 256 x 128 pixels; nothing where its
/// pixels are small enough. Precondition: there is a map.
std::optional<formats::Environment> refine_map(const formats::Environment& map);

/// Calls f(radiance, direction, solid angle) for every pixel: Rgb, unit Vec3 in the frame of the
/// map, double [sr] (map_geometry.h). Row by row.
template <class Function>
void for_cells(const formats::Environment& map, const Function& f) {
    using std::numbers::pi;
    const std::vector<double> edges = row_edges(map);
    if (map.layout == formats::Environment::Layout::cube) {
        const std::uint32_t n = map.width;
        for (std::uint32_t row = 0; row < map.height; ++row) {
            for (std::uint32_t column = 0; column < n; ++column) {
                f(map.pixel[std::size_t{row} * n + column],
                  formats::texel_direction(n, row / n, row % n, column),
                  cell_solid_angle(map, edges, column, row));
            }
        }
        return;
    }
    std::vector<float> x(map.width), z(map.width);
    for (std::uint32_t column = 0; column < map.width; ++column) {
        const double turn = (column + 0.5) / map.width - static_cast<double>(map.u_offset);
        const double phi = 2 * pi * static_cast<double>(map.u_sign) * turn;
        x[column] = static_cast<float>(std::cos(phi));
        z[column] = static_cast<float>(std::sin(phi));
    }
    for (std::uint32_t row = 0; row < map.height; ++row) {
        const double polar =
            map.rows_include_poles ? pi * row / (map.height - 1) : pi * (row + 0.5) / map.height;
        const auto sine = static_cast<float>(std::sin(polar));
        const auto y = static_cast<float>(std::cos(polar));
        const double solid_angle = cell_solid_angle(map, edges, 0, row);
        for (std::uint32_t column = 0; column < map.width; ++column) {
            f(map.pixel[std::size_t{row} * map.width + column],
              formats::Vec3{sine * x[column], y, sine * z[column]}, solid_angle);
        }
    }
}

/// A small light in a map, in the map's frame. Within `kPeakReach` of its brightest pixel,
/// luminance above the threshold belongs to the light, in the pixel's colour.
struct MapPeak {
    formats::Vec3 brightest;  ///< unit
    double threshold = 0;     ///< luminance, >= 0
    formats::Vec3 direction;  ///< unit, centroid of the light
    formats::Rgb irradiance;  ///< on a plane facing it [W m^-2]
    double radius = 0;        ///< of a disc with the same spread [rad]
};

inline constexpr double kPeakReach = 5 * std::numbers::pi / 180;  ///< [rad]

/// The strongest light that stands out of a map. The threshold is four times the mean luminance
/// between 6 and 12 degrees from the brightest pixel, or of the whole map beyond kPeakReach if that
/// is more. There is a light if the brightest pixel has twice the threshold and the light's
/// irradiance is 2 % of that of a hemisphere of the mean luminance, so that a single damaged pixel
/// rarely counts. Up to eight places are compared, more than 12 degrees apart, brightest first.
std::optional<MapPeak> find_peak(const formats::Environment& map);

/// The light's share of a pixel's radiance: luminance above the threshold over luminance.
formats::Rgb above_threshold(formats::Rgb radiance, float threshold);

}  // namespace opaline::runtime
