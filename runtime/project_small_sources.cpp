#include "runtime/project_small_sources.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

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

// The texels that a part's corners lie in: x0 y0, x1 y0, x0 y1, x1 y1.
using Corners = std::array<std::uint32_t, 4>;

// Gives a part to the texel it lies in, or halves it until each piece lies in one or is too small
// to matter. `texel_at(x, y)` and `weight_of(part)` describe the pixel.
template <class TexelAt, class WeightOf>
void divide(const Part& p, const Corners& corner, unsigned depth, const TexelAt& texel_at,
            const WeightOf& weight_of, std::vector<Point>& points) {
    const double x = 0.5 * (p.x0 + p.x1), y = 0.5 * (p.y0 + p.y1);
    const std::uint32_t texel = texel_at(x, y);
    if (depth == 0 || std::count(corner.begin(), corner.end(), texel) == 4) {
        points.push_back({texel, weight_of(p)});
        return;
    }
    const std::uint32_t up = texel_at(x, p.y0), down = texel_at(x, p.y1), left = texel_at(p.x0, y),
                        right = texel_at(p.x1, y);
    const auto quarter = [&](const Part& part, const Corners& of) {
        divide(part, of, depth - 1, texel_at, weight_of, points);
    };
    quarter({p.x0, x, p.y0, y}, {corner[0], up, left, texel});
    quarter({x, p.x1, p.y0, y}, {up, corner[1], texel, right});
    quarter({p.x0, x, y, p.y1}, {left, texel, corner[2], down});
    quarter({x, p.x1, y, p.y1}, {texel, right, down, corner[3]});
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
        const Corners corner{texel_at(quadrant.x0, quadrant.y0), texel_at(quadrant.x1, quadrant.y0),
                             texel_at(quadrant.x0, quadrant.y1),
                             texel_at(quadrant.x1, quadrant.y1)};
        divide(quadrant, corner, depth, texel_at, weight_of, points);
    }
}

// Below this many times the mean radiance one pixel does not matter to a texel of many.
constexpr float kTimesMean = 8.0f;
constexpr float kTimesSurroundings = 2.0f;

// Relative solid angle of a pixel, up to a constant factor.
class PixelWeights {
  public:
    explicit PixelWeights(const Environment& map)
        : map_(map),
          edges_(map.layout == Environment::Layout::cube ? std::vector<double>{} : row_edges(map)) {
    }
    void move_to(std::uint32_t row) {
        if (map_.layout == Environment::Layout::cube) {
            v_squared_ = square_at(row % map_.width);
        } else {
            of_row_ = cell_solid_angle(map_, edges_, 0, row);
        }
    }
    double at(std::uint32_t column) const {
        if (map_.layout != Environment::Layout::cube) return of_row_;
        const double r = 1 + square_at(column) + v_squared_;
        return 1 / (r * std::sqrt(r));
    }

  private:
    double square_at(std::uint32_t i) const {
        const double x = (2.0 * i + 1) / map_.width - 1;
        return x * x;
    }
    const Environment& map_;
    std::vector<double> edges_;
    double v_squared_ = 0, of_row_ = 0;
};

Rgb mean_radiance(const Environment& map) {
    PixelWeights weights(map);
    std::array<double, 3> sum{};
    double total = 0;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        weights.move_to(row);
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const Rgb p = map.pixel[std::size_t{row} * map.width + column];
            const double weight = weights.at(column);
            total += weight;
            sum[0] += weight * static_cast<double>(p.r);
            sum[1] += weight * static_cast<double>(p.g);
            sum[2] += weight * static_cast<double>(p.b);
        }
    }
    return {static_cast<float>(sum[0] / total), static_cast<float>(sum[1] / total),
            static_cast<float>(sum[2] / total)};
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
    for (std::uint32_t row = 0; row < map.height; ++row) {
        for (std::uint32_t column = 0; column < map.width; ++column) {
            const Rgb p = map.pixel[std::size_t{row} * map.width + column];
            if (p.r <= floor.r && p.g <= floor.g && p.b <= floor.b) continue;
            const Rgb around = kTimesSurroundings * surroundings(map, column, row);
            const Rgb most{std::max(floor.r, around.r), std::max(floor.g, around.g),
                           std::max(floor.b, around.b)};
            const Rgb excess{std::max(p.r - most.r, 0.0f), std::max(p.g - most.g, 0.0f),
                             std::max(p.b - most.b, 0.0f)};
            if (excess.r > 0 || excess.g > 0 || excess.b > 0) {
                bright.push_back({column, row, excess});
            }
        }
    }
    for (const BrightPixel& b : bright) {  // after all have been compared with their surroundings
        Rgb& p = map.pixel[std::size_t{b.row} * map.width + b.column];
        p = {p.r - b.radiance.r, p.g - b.radiance.g, p.b - b.radiance.b};
    }
    return bright;
}

namespace {

// What a texel gets of a bright pixel.
struct PixelShare {
    std::uint32_t texel = 0;
    double weight = 0;
    Rgb radiance;
};

void append_shares(std::span<const Point> points, double solid_angle, Rgb radiance,
                   std::vector<PixelShare>& shares) {
    const std::size_t first = shares.size();
    double total = 0;
    for (const Point& point : points) {
        total += point.weight;
        std::size_t i = first;  // a pixel touches a few texels only
        while (i < shares.size() && shares[i].texel != point.texel) {
            ++i;
        }
        if (i == shares.size()) shares.push_back({point.texel, 0, radiance});
        shares[i].weight += point.weight;
    }
    for (std::size_t i = first; i < shares.size(); ++i) {
        shares[i].weight *= solid_angle / total;
    }
}

}  // namespace

void project_small_sources(const Environment& shape, std::span<const BrightPixel> bright,
                           std::uint32_t n, const Rotation& rotation, unsigned threads,
                           std::span<double> integral) {
    if (bright.empty()) return;
    const bool cube = shape.layout == Environment::Layout::cube;
    const std::vector<double> edges = cube ? std::vector<double>{} : row_edges(shape);
    // Four halvings leave pieces of 1/16 pixel at the border between texels: finer than the grid of
    // points by which the rest of the map is summed.
    const unsigned depth = bright.size() <= 50000 ? 4 : 3;
    // Added in the order of pixels: the rounding is the same for any number of threads.
    constexpr std::uint32_t kAtOnce = 64;
    const auto count = static_cast<std::uint32_t>(bright.size());
    std::vector<std::vector<PixelShare>> parts((count + kAtOnce - 1) / kAtOnce);
    for_ranges(count, kAtOnce, threads, [&](std::uint32_t begin, std::uint32_t end) {
        std::vector<Point> points;
        for (const BrightPixel& p : bright.subspan(begin, end - begin)) {
            divide_pixel(shape, p, n, rotation, depth, points);
            append_shares(points, cell_solid_angle(shape, edges, p.column, p.row), p.radiance,
                          parts[begin / kAtOnce]);
        }
    });
    for (const std::vector<PixelShare>& shares : parts) {
        for (const PixelShare& share : shares) {
            double* const texel = &integral[std::size_t{3} * share.texel];
            texel[0] += share.weight * static_cast<double>(share.radiance.r);
            texel[1] += share.weight * static_cast<double>(share.radiance.g);
            texel[2] += share.weight * static_cast<double>(share.radiance.b);
        }
    }
}

namespace {
constexpr std::size_t kMostSources = 32768;  // a third of a millisecond
}

std::vector<SmallSource> divide_sources(const Environment& shape,
                                        std::span<const BrightPixel> bright) {
    const bool cube = shape.layout == Environment::Layout::cube;
    const std::vector<double> edges = cube ? std::vector<double>{} : row_edges(shape);
    std::uint32_t side = 16;
    while (side > 2 && bright.size() * side * side > kMostSources) {
        side /= 2;
    }
    std::vector<SmallSource> sources;
    sources.reserve(bright.size() * side * side);
    for (const BrightPixel& pixel : bright) {
        const std::uint32_t face = cube ? pixel.row / shape.width : 0;
        const std::uint32_t row = cube ? pixel.row % shape.width : pixel.row;
        const std::size_t first = sources.size();
        double total = 0;
        std::array<double, 256> weight{};
        for (std::uint32_t i = 0; i < side * side; ++i) {
            const std::uint32_t across = i % side, down = i / side;
            const double x = (2.0 * across + 1) / side - 1, y = (2.0 * down + 1) / side - 1;
            const Look look = cube ? look_cube(shape, face, pixel.column + x, row + y)
                                   : look_lat_long(shape, pixel.column + x, row + y);
            weight[i] = (1 - std::abs(x)) * (1 - std::abs(y)) * look.density;
            total += weight[i];
            sources.push_back({look.direction, {}});
        }
        const double flux = cell_solid_angle(shape, edges, pixel.column, pixel.row) / total;
        for (std::uint32_t i = 0; i < side * side; ++i) {
            sources[first + i].flux = static_cast<float>(flux * weight[i]) * pixel.radiance;
        }
    }
    return sources;
}

void project_sources(std::span<const SmallSource> sources, std::uint32_t n,
                     const Rotation& rotation, std::span<double> integral) {
    for (const SmallSource& source : sources) {
        const std::uint32_t texel =
            formats::texel_index(n, rotation.world_from_light(source.direction));
        double* const sum = &integral[std::size_t{3} * texel];
        sum[0] += static_cast<double>(source.flux.r);
        sum[1] += static_cast<double>(source.flux.g);
        sum[2] += static_cast<double>(source.flux.b);
    }
}

}  // namespace opaline::runtime
