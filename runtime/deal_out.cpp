#include "runtime/deal_out.h"

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
using formats::Vec3;
using std::numbers::pi;

// Points across the footprint of two pixels: a quarter of a pixel apart.
constexpr std::uint32_t kPoints = 8;

struct Point {
    std::uint32_t texel = 0;
    double weight = 0;
};
using Footprint = std::array<Point, std::size_t{kPoints} * kPoints>;

struct Offset {
    double shift = 0;  // from the pixel's centre [pixels]
    double tent = 0;   // bilinear weight there
};
Offset offset(std::uint32_t i) {
    const double shift = (2.0 * i + 1.0) / kPoints - 1.0;
    return {shift, 1.0 - std::abs(shift)};
}

// Inverse of the lookup in formats::sample_map.
Footprint lat_long_footprint(const Environment& map, std::uint32_t column, std::uint32_t row,
                             std::uint32_t n, const Rotation& rotation) {
    const double spacing =
        map.rows_include_poles ? pi / std::max(map.height - 1.0, 1.0) : pi / map.height;
    const double centre = map.rows_include_poles ? row * spacing : (row + 0.5) * spacing;
    Footprint points;
    for (std::uint32_t j = 0; j < kPoints; ++j) {
        const Offset down = offset(j);
        const double theta = centre + down.shift * spacing;
        if (theta <= 0 || theta >= pi) {
            continue;  // beyond a pole: weight stays 0
        }
        // Between a pole and the row next to it the map is constant.
        const bool at_pole =
            (row == 0 && down.shift < 0) || (row + 1 == map.height && down.shift > 0);
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const Offset across = offset(i);
            const double u = (column + 0.5 + across.shift) / map.width;
            const double phi = 2.0 * pi * (u - static_cast<double>(map.u_offset)) *
                               static_cast<double>(map.u_sign);
            const Vec3 d{static_cast<float>(std::sin(theta) * std::cos(phi)),
                         static_cast<float>(std::cos(theta)),
                         static_cast<float>(std::sin(theta) * std::sin(phi))};
            points[std::size_t{j} * kPoints + i] = {
                formats::texel_index(n, rotation.world_from_light(d)),
                (at_pole ? 1.0 : down.tent) * across.tent * std::sin(theta)};
        }
    }
    return points;
}

Footprint cube_footprint(const Environment& map, std::uint32_t column, std::uint32_t row,
                         std::uint32_t n, const Rotation& rotation) {
    const std::uint32_t size = map.width;
    Footprint points;
    for (std::uint32_t j = 0; j < kPoints; ++j) {
        for (std::uint32_t i = 0; i < kPoints; ++i) {
            const Offset across = offset(i), down = offset(j);
            const double u = 2.0 * (column + 0.5 + across.shift) / size - 1.0;
            const double v = 2.0 * (row % size + 0.5 + down.shift) / size - 1.0;
            const Vec3 d =
                formats::cube_position({row / size, static_cast<float>(u), static_cast<float>(v)});
            // d solid angle / (du dv) = (1 + u^2 + v^2)^(-3/2).
            points[std::size_t{j} * kPoints + i] = {
                formats::texel_index(n, rotation.world_from_light(d)),
                across.tent * down.tent * std::pow(1.0 + u * u + v * v, -1.5)};
        }
    }
    return points;
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

void deal_out(const Environment& map, std::span<const BrightPixel> bright, std::uint32_t n,
              const Rotation& rotation, unsigned threads, std::span<double> integral) {
    if (bright.empty()) {
        return;
    }
    const bool cube = map.layout == Environment::Layout::cube;
    const std::vector<double> edges = cube ? std::vector<double>{} : row_edges(map);
    // A fixed number of shares, summed in order: the rounding is the same for any thread count.
    constexpr std::uint32_t kShares = 8;
    std::array<std::vector<double>, kShares> partial;
    for (std::vector<double>& sum : partial) {
        sum.assign(integral.size(), 0.0);
    }
    for_ranges(kShares, 1, threads, [&](std::uint32_t share, std::uint32_t) {
        std::vector<double>& sum = partial[share];
        const std::size_t begin = bright.size() * share / kShares;
        const std::size_t end = bright.size() * (share + 1) / kShares;
        for (const BrightPixel& p : bright.subspan(begin, end - begin)) {
            const Footprint points = cube ? cube_footprint(map, p.column, p.row, n, rotation)
                                          : lat_long_footprint(map, p.column, p.row, n, rotation);
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
