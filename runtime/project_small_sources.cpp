#include "runtime/project_small_sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "formats/opal/cubemap.h"
#include "runtime/map_geometry.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using std::numbers::pi;

struct Point {
    std::uint32_t texel = 0;
    double weight = 0;
};

// Where a map looks, as a function of pixel coordinates (centres at whole numbers).
struct Look {
    formats::Vec3 direction;
    double density = 0;  // solid angle per pixel area, up to a constant factor
};

// Inverse of the lookup in formats::sample_map; rows beyond a pole have no density.
Look look_lat_long(const Environment& map, double x, double y) {
    const double theta = map.rows_include_poles ? pi * y / std::max(map.height - 1.0, 1.0)
                                                : pi * (y + 0.5) / map.height;
    const double phi = 2.0 * pi * ((x + 0.5) / map.width - static_cast<double>(map.u_offset)) *
                       static_cast<double>(map.u_sign);
    const double sine = theta > 0 && theta < pi ? std::sin(theta) : 0.0;
    return {{static_cast<float>(sine * std::cos(phi)),
             static_cast<float>(std::cos(std::clamp(theta, 0.0, pi))),
             static_cast<float>(sine * std::sin(phi))},
            sine};
}

Look look_cube(const Environment& map, std::uint32_t face, double x, double y) {
    const double u = 2.0 * (x + 0.5) / map.width - 1.0, v = 2.0 * (y + 0.5) / map.width - 1.0;
    // d solid angle / (du dv) = (1 + u^2 + v^2)^(-3/2).
    const double r = 1.0 + u * u + v * v;
    return {formats::cube_position({face, static_cast<float>(u), static_cast<float>(v)}),
            1.0 / (r * std::sqrt(r))};
}

// A part [x0, x1] x [y0, y1] of a pixel's bilinear footprint, relative to its centre.
struct Part {
    double x0 = 0, x1 = 0, y0 = 0, y1 = 0;
};

// Integral of the tent 1 - |t| over an interval on one side of 0.
double tent(double a, double b) {
    return (b - a) * (1.0 - std::abs(0.5 * (a + b)));
}

// Gives a part to the texel it lies in, or halves it until each piece lies in one or is too small
// to matter. `texel_at(x, y)` and `weight_of(part)` describe the pixel.
template <class TexelAt, class WeightOf>
void divide(const Part& p, unsigned depth, const TexelAt& texel_at, const WeightOf& weight_of,
            std::vector<Point>& points) {
    const double x = 0.5 * (p.x0 + p.x1), y = 0.5 * (p.y0 + p.y1);
    const std::uint32_t texel = texel_at(x, y);
    if (depth == 0 || (texel == texel_at(p.x0, p.y0) && texel == texel_at(p.x1, p.y0) &&
                       texel == texel_at(p.x0, p.y1) && texel == texel_at(p.x1, p.y1))) {
        points.push_back({texel, weight_of(p)});
        return;
    }
    for (const Part& quarter : {Part{p.x0, x, p.y0, y}, Part{x, p.x1, p.y0, y},
                                Part{p.x0, x, y, p.y1}, Part{x, p.x1, y, p.y1}}) {
        divide(quarter, depth - 1, texel_at, weight_of, points);
    }
}

void divide_pixel(const Environment& map, const BrightPixel& pixel, std::uint32_t n,
                  const Rotation& rotation, unsigned depth, std::vector<Point>& points) {
    const bool cube = map.layout == Environment::Layout::cube;
    const std::uint32_t face = cube ? pixel.row / map.width : 0;
    const std::uint32_t row = cube ? pixel.row % map.width : pixel.row;
    const auto look = [&](double x, double y) {
        return cube ? look_cube(map, face, pixel.column + x, row + y)
                    : look_lat_long(map, pixel.column + x, row + y);
    };
    const auto texel_at = [&](double x, double y) {
        return formats::texel_index(n, rotation.world_from_light(look(x, y).direction));
    };
    const auto weight_of = [&](const Part& p) {
        // Between a pole and the row next to it a lat-long map is constant.
        const bool at_pole =
            !cube && ((row == 0 && p.y1 <= 0) || (row + 1 == map.height && p.y0 >= 0));
        return tent(p.x0, p.x1) * (at_pole ? p.y1 - p.y0 : tent(p.y0, p.y1)) *
               look(0.5 * (p.x0 + p.x1), 0.5 * (p.y0 + p.y1)).density;
    };
    points.clear();
    for (const Part& quadrant :
         {Part{-1, 0, -1, 0}, Part{0, 1, -1, 0}, Part{-1, 0, 0, 1}, Part{0, 1, 0, 1}}) {
        divide(quadrant, depth, texel_at, weight_of, points);
    }
}

// Below this many times the mean radiance one pixel does not matter to a texel of many.
constexpr float kTimesMean = 8.0f;
constexpr float kTimesSurroundings = 2.0f;

Rgb mean_radiance(const Environment& map) {
    const std::vector<double> edges =
        map.layout == Environment::Layout::cube ? std::vector<double>{} : row_edges(map);
    std::array<double, 3> mean{};
    for (std::uint32_t row = 0; row < map.height; ++row) {
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const Rgb p = map.pixel[std::size_t{row} * map.width + column];
            const double share = cell_solid_angle(map, edges, column, row) / (4.0 * pi);
            mean[0] += share * static_cast<double>(p.r);
            mean[1] += share * static_cast<double>(p.g);
            mean[2] += share * static_cast<double>(p.b);
        }
    }
    return {static_cast<float>(mean[0]), static_cast<float>(mean[1]), static_cast<float>(mean[2])};
}

// How bright a pixel would be if the map were straight between the pixels three away to either
// side, in that of four directions in which it is least: small next to a dot, a line or a corner,
// the pixel's own value where the map is smooth, at least half of it along an edge.
Rgb surroundings(const Environment& map, std::uint32_t column, std::uint32_t row) {
    constexpr std::int64_t kDistance = 3;
    const bool cube = map.layout == Environment::Layout::cube;
    const auto width = static_cast<std::int64_t>(map.width);
    // Rows stay in their face, columns of a lat-long map go round.
    const std::int64_t first_row = cube ? row / map.width * width : 0;
    const std::int64_t last_row = cube ? first_row + width - 1 : std::int64_t{map.height} - 1;
    const auto at = [&](std::int64_t across, std::int64_t down) {
        std::int64_t x = std::int64_t{column} + across;
        x = cube ? std::clamp<std::int64_t>(x, 0, width - 1) : (x % width + width) % width;
        const std::int64_t y = std::clamp(std::int64_t{row} + down, first_row, last_row);
        return map.pixel[static_cast<std::size_t>(y * width + x)];
    };
    constexpr std::int64_t d = kDistance;
    Rgb least{std::numeric_limits<float>::infinity(), std::numeric_limits<float>::infinity(),
              std::numeric_limits<float>::infinity()};
    constexpr std::array<std::array<std::int64_t, 2>, 4> kDirections{
        {{d, 0}, {0, d}, {d, d}, {d, -d}}};
    for (const auto& [across, down] : kDirections) {
        const Rgb mean = 0.5f * at(across, down) + 0.5f * at(-across, -down);
        least = {std::min(least.r, mean.r), std::min(least.g, mean.g), std::min(least.b, mean.b)};
    }
    return least;
}

}  // namespace

std::vector<BrightPixel> take_bright_pixels(Environment& map) {
    const Rgb floor = kTimesMean * mean_radiance(map);
    std::vector<BrightPixel> bright;
    std::vector<Rgb> kept = map.pixel;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const Rgb p = map.pixel[std::size_t{row} * map.width + column];
            if (p.r <= floor.r && p.g <= floor.g && p.b <= floor.b) {
                continue;
            }
            const Rgb around = kTimesSurroundings * surroundings(map, column, row);
            const Rgb most{std::max(floor.r, around.r), std::max(floor.g, around.g),
                           std::max(floor.b, around.b)};
            const Rgb excess{std::max(p.r - most.r, 0.0f), std::max(p.g - most.g, 0.0f),
                             std::max(p.b - most.b, 0.0f)};
            if (excess.r > 0 || excess.g > 0 || excess.b > 0) {
                bright.push_back({column, row, excess});
                kept[std::size_t{row} * map.width + column] = {
                    std::min(p.r, most.r), std::min(p.g, most.g), std::min(p.b, most.b)};
            }
        }
    }
    map.pixel = std::move(kept);
    return bright;
}

void project_small_sources(const Environment& map, std::span<const BrightPixel> bright,
                           std::uint32_t n, const Rotation& rotation, unsigned threads,
                           std::span<double> integral) {
    if (bright.empty()) {
        return;
    }
    const bool cube = map.layout == Environment::Layout::cube;
    const std::vector<double> edges = cube ? std::vector<double>{} : row_edges(map);
    // Six halvings leave pieces of 1/64 pixel at the border between texels.
    const unsigned depth = bright.size() <= 50000 ? 6 : 4;
    // A fixed number of shares, summed in order: the rounding is the same for any thread count.
    constexpr std::uint32_t kShares = 8;
    std::array<std::vector<double>, kShares> partial;
    for (std::vector<double>& sum : partial) {
        sum.assign(integral.size(), 0.0);
    }
    for_ranges(kShares, 1, threads, [&](std::uint32_t share, std::uint32_t) {
        std::vector<double>& sum = partial[share];
        std::vector<Point> points;
        const std::size_t begin = bright.size() * share / kShares;
        const std::size_t end = bright.size() * (share + 1) / kShares;
        for (const BrightPixel& p : bright.subspan(begin, end - begin)) {
            divide_pixel(map, p, n, rotation, depth, points);
            double total = 0;
            for (const Point& point : points) {
                total += point.weight;
            }
            const double scale = cell_solid_angle(map, edges, p.column, p.row) / total;
            for (const Point& point : points) {
                double* texel = &sum[std::size_t{3} * point.texel];
                texel[0] += scale * point.weight * static_cast<double>(p.radiance.r);
                texel[1] += scale * point.weight * static_cast<double>(p.radiance.g);
                texel[2] += scale * point.weight * static_cast<double>(p.radiance.b);
            }
        }
    });
    for (const std::vector<double>& sum : partial) {
        for (std::size_t i = 0; i < sum.size(); ++i) {
            integral[i] += sum[i];
        }
    }
}

}  // namespace opaline::runtime
