#include "runtime/reduce_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "formats/opal/cubemap.h"
#include "runtime/map_geometry.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using Double3 = std::array<double, 3>;

// A piece of a new cell that lies in one old cell: [begin, end] of their common coordinate.
struct Piece {
    std::uint32_t from = 0;
    double begin = 0, end = 0;
};

// The pieces of the interval [low, high]; `edge` holds the ascending borders of the old cells.
std::vector<Piece> cut(const std::vector<double>& edge, double low, double high) {
    std::vector<Piece> pieces;
    const auto after = std::upper_bound(edge.begin(), edge.end(), low);
    const auto start = std::min<std::ptrdiff_t>(std::max<std::ptrdiff_t>(after - edge.begin(), 1),
                                                std::ssize(edge) - 1);
    for (auto i = static_cast<std::size_t>(start - 1); i + 1 < edge.size() && edge[i] < high; ++i) {
        pieces.push_back(
            {static_cast<std::uint32_t>(i), std::max(low, edge[i]), std::min(high, edge[i + 1])});
    }
    return pieces;
}

std::vector<double> even_edges(std::uint32_t cells, double low, double high) {
    std::vector<double> edge(std::size_t{cells} + 1);
    for (std::uint32_t e = 0; e <= cells; ++e) {
        edge[e] = low + (high - low) * e / cells;
    }
    return edge;
}

void add(Double3& sum, double weight, const Rgb& value) {
    sum[0] += weight * static_cast<double>(value.r);
    sum[1] += weight * static_cast<double>(value.g);
    sum[2] += weight * static_cast<double>(value.b);
}

Rgb mean(const Double3& sum, double weight) {
    return {static_cast<float>(sum[0] / weight), static_cast<float>(sum[1] / weight),
            static_cast<float>(sum[2] / weight)};
}

// The pieces of every new cell along one axis.
std::vector<std::vector<Piece>> cut_all(const std::vector<double>& from,
                                        const std::vector<double>& to) {
    std::vector<std::vector<Piece>> pieces(to.size() - 1);
    for (std::size_t cell = 0; cell + 1 < to.size(); ++cell) {
        pieces[cell] = cut(from, to[cell], to[cell + 1]);
    }
    return pieces;
}

}  // namespace

Environment reduce_lat_long(const Environment& map, std::uint32_t max_width,
                            std::uint32_t max_height, unsigned threads) {
    Environment out = map;
    out.discs.clear();
    if (map.width <= max_width && map.height <= max_height) return out;
    out.width = std::min(map.width, max_width);
    out.height = std::min(map.height, max_height);
    out.rows_include_poles = false;
    out.pixel.assign(std::size_t{out.width} * out.height, Rgb{});
    const auto columns = cut_all(even_edges(map.width, 0, 1), even_edges(out.width, 0, 1));
    const auto rows = cut_all(row_edges(map), even_edges(out.height, 0, std::numbers::pi));
    for_ranges(out.height, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        for (std::uint32_t column = 0; column < out.width; ++column) {
            Double3 sum{};
            double weight = 0;
            for (const Piece& r : rows[row]) {
                const double band =
                    2.0 * std::sin(0.5 * (r.begin + r.end)) * std::sin(0.5 * (r.end - r.begin));
                for (const Piece& c : columns[column]) {
                    const double solid_angle = band * (c.end - c.begin);
                    add(sum, solid_angle, map.pixel[std::size_t{r.from} * map.width + c.from]);
                    weight += solid_angle;
                }
            }
            out.pixel[std::size_t{row} * out.width + column] = mean(sum, weight);
        }
    });
    return out;
}

Environment reduce_cube(const Environment& map, std::uint32_t max_size, unsigned threads) {
    Environment out = map;
    out.discs.clear();
    if (map.width <= max_size) return out;
    const std::uint32_t n = max_size, old_n = map.width;
    out.width = n;
    out.height = formats::kCubeFaces * n;
    out.pixel.assign(formats::cubemap_texels(n), Rgb{});
    const auto pieces = cut_all(even_edges(old_n, -1, 1), even_edges(n, -1, 1));
    for_ranges(n, 1, threads, [&](std::uint32_t row, std::uint32_t) {
        for (std::uint32_t column = 0; column < n; ++column) {
            std::array<Double3, formats::kCubeFaces> sum{};
            double weight = 0;
            for (const Piece& r : pieces[row]) {
                for (const Piece& c : pieces[column]) {
                    const double solid_angle =
                        formats::rectangle_solid_angle(c.begin, r.begin, c.end, r.end);
                    weight += solid_angle;
                    for (std::size_t face = 0; face < sum.size(); ++face) {
                        add(sum[face], solid_angle,
                            map.pixel[(face * old_n + r.from) * old_n + c.from]);
                    }
                }
            }
            for (std::size_t face = 0; face < sum.size(); ++face) {
                out.pixel[(face * n + row) * n + column] = mean(sum[face], weight);
            }
        }
    });
    return out;
}

}  // namespace opaline::runtime
