#include "runtime/web/divide_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "formats/opal/cubemap.h"
#include "runtime/gloss_light.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/map_geometry.h"
#include "runtime/project_small_sources.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;

// Where a map looks, in pixels; centres at whole numbers. Inverse of formats::sample_map.
Vec3 look(const Environment& map, double x, double y) {
    if (map.layout == Environment::Layout::cube) {
        const auto n = static_cast<double>(map.width);
        const double face = std::clamp(std::floor((y + 0.5) / n), 0.0, 5.0);
        return normalize(formats::cube_position(
            {static_cast<std::uint32_t>(face), static_cast<float>(2 * (x + 0.5) / n - 1),
             static_cast<float>(2 * (y - n * face + 0.5) / n - 1)}));
    }
    const double theta = map.rows_include_poles ? pi * y / std::max(map.height - 1.0, 1.0)
                                                : pi * (y + 0.5) / map.height;
    const double phi = 2 * pi * ((x + 0.5) / map.width - static_cast<double>(map.u_offset)) *
                       static_cast<double>(map.u_sign);
    return {static_cast<float>(std::sin(theta) * std::cos(phi)),
            static_cast<float>(std::cos(theta)),
            static_cast<float>(std::sin(theta) * std::sin(phi))};
}

// Few pixels are divided, so that their light moves evenly from texel to texel as it turns.
int points_across(std::size_t pixels) {
    return pixels <= 512 ? 4 : pixels <= 8192 ? 2 : 1;
}

std::vector<float> points_of(const Environment& map, std::span<const BrightPixel> bright) {
    const std::vector<double> edges =
        map.layout == Environment::Layout::cube ? std::vector<double>{} : row_edges(map);
    const int across = points_across(bright.size());
    const float share = 1.0f / static_cast<float>(across * across);
    std::vector<float> points;
    points.reserve(bright.size() * 6 * static_cast<std::size_t>(across * across));
    for (const BrightPixel& pixel : bright) {
        const auto solid_angle =
            static_cast<float>(cell_solid_angle(map, edges, pixel.column, pixel.row));
        const Rgb flux = (share * solid_angle) * pixel.radiance;
        for (int i = 0; i < across * across; ++i) {
            const auto offset = [across](int k) { return (k + 0.5) / across - 0.5; };
            const Vec3 d =
                look(map, pixel.column + offset(i % across), pixel.row + offset(i / across));
            points.insert(points.end(), {d.x, d.y, d.z, flux.r, flux.g, flux.b});
        }
    }
    return points;
}

// Pixels that a texel holds several of can be points beside it.
std::vector<float> take_points(Environment& map) {
    if (map.pixel.empty() || pixel_size(map).larger >= 1.0 / kPageTexels) return {};
    const std::vector<BrightPixel> bright = take_bright_pixels(map);
    return points_of(map, bright);
}

float storable(double radiance) {
    return static_cast<float>(std::clamp(radiance, 0.0, 1e35));
}

}  // namespace

DividedLight divide_light(const Environment& environment, unsigned threads) {
    DividedLight light;
    Environment map = environment;
    std::vector<formats::DistantDisc> large;
    for (const formats::DistantDisc& disc : environment.discs) {
        (disc.angular_radius <= kLargestSun ? light.suns : large).push_back(disc);
    }
    light.points = take_points(map);
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(kPageTexels));
    integrate_map(map, kPageTexels, {}, threads, integral);
    integrate_discs(large, kPageTexels, {}, integral);
    const std::vector<double> solid_angle = formats::texel_solid_angles(kPageTexels);
    light.cube.reserve(integral.size() / 3);
    for (std::size_t j = 0; 3 * j < integral.size(); ++j) {
        const double inverse = 1 / solid_angle[j % solid_angle.size()];
        light.cube.push_back({storable(inverse * integral[3 * j]),
                              storable(inverse * integral[3 * j + 1]),
                              storable(inverse * integral[3 * j + 2])});
    }
    return light;
}

}  // namespace opaline::runtime
