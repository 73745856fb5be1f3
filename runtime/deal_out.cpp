#include "runtime/deal_out.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

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

}  // namespace

std::vector<BrightPixel> take_bright_pixels(Environment& map) {
    constexpr double kBright = 8.0;
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
    const Rgb most{static_cast<float>(kBright * mean[0]), static_cast<float>(kBright * mean[1]),
                   static_cast<float>(kBright * mean[2])};
    std::vector<BrightPixel> bright;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        for (std::uint32_t column = 0; column < map.width; ++column) {
            Rgb& p = map.pixel[std::size_t{row} * map.width + column];
            if (p.r > most.r || p.g > most.g || p.b > most.b) {
                const Rgb kept{std::min(p.r, most.r), std::min(p.g, most.g), std::min(p.b, most.b)};
                bright.push_back({column, row, {p.r - kept.r, p.g - kept.g, p.b - kept.b}});
                p = kept;
            }
        }
    }
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
