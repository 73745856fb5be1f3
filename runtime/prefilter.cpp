// SpecularLight: the environment, convolved.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "formats/opal/cubemap.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/parallel.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using Double3 = std::array<double, 3>;

// Texels of a cube map face that are taken together.
struct Cell {
    Double3 flux{};  // integral of radiance [W m^-2]
    Vec3 centre;     // unit
    float solid_angle = 0;
    Vec3 flux_centre;  // unit, weighted with light: a lone sun stays in its place
};

// A quadtree over each face: level l has 2^l x 2^l cells a face.
struct Pyramid {
    std::vector<std::vector<Cell>> level;
};

void add(Double3& sum, double weight, const Double3& value) {
    for (std::size_t i = 0; i < 3; ++i) {
        sum[i] += weight * value[i];
    }
}

Vec3 unit(const Double3& v, Vec3 otherwise) {
    const double norm = std::hypot(v[0], v[1], v[2]);
    if (!(norm > 0) || !std::isfinite(norm)) return otherwise;
    return {static_cast<float>(v[0] / norm), static_cast<float>(v[1] / norm),
            static_cast<float>(v[2] / norm)};
}

double luminance(const Double3& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

// What a cell is made from: its first moments, before they are normalised.
struct CellSum {
    Double3 flux{}, moment{}, flux_moment{};
    double solid_angle = 0;
};

Cell finish(const CellSum& sum) {
    Cell cell;
    cell.flux = sum.flux;
    cell.solid_angle = static_cast<float>(sum.solid_angle);
    cell.centre = unit(sum.moment, {0, 0, 1});
    cell.flux_centre = unit(sum.flux_moment, cell.centre);
    return cell;
}

std::vector<CellSum> sum_texels(std::span<const double> integral, std::uint32_t n) {
    const std::vector<double> solid_angle = formats::texel_solid_angles(n);
    const std::vector<Vec3> moments = formats::texel_moments(n);
    std::vector<CellSum> sums(moments.size());
    for (std::size_t j = 0; j < sums.size(); ++j) {
        CellSum& sum = sums[j];
        const Vec3 m = moments[j];
        sum.flux = {integral[3 * j], integral[3 * j + 1], integral[3 * j + 2]};
        sum.solid_angle = solid_angle[j % solid_angle.size()];
        sum.moment = {static_cast<double>(m.x), static_cast<double>(m.y), static_cast<double>(m.z)};
        add(sum.flux_moment, luminance(sum.flux) / sum.solid_angle, sum.moment);
    }
    return sums;
}

// From n x n cells a face to half as many a side.
std::vector<CellSum> sum_quarters(const std::vector<CellSum>& fine, std::uint32_t n) {
    std::vector<CellSum> coarse(fine.size() / 4);
    for (std::size_t j = 0; j < fine.size(); ++j) {
        const std::size_t row = j / n, column = j % n;  // rows of all faces
        CellSum& sum = coarse[row / 2 * (n / 2) + column / 2];
        add(sum.flux, 1, fine[j].flux);
        add(sum.moment, 1, fine[j].moment);
        add(sum.flux_moment, 1, fine[j].flux_moment);
        sum.solid_angle += fine[j].solid_angle;
    }
    return coarse;
}

Pyramid make_pyramid(std::span<const double> integral, std::uint32_t n) {
    Pyramid pyramid;
    std::vector<CellSum> sums = sum_texels(integral, n);
    for (std::uint32_t size = n; size > 0; size /= 2) {
        std::vector<Cell>& cells = pyramid.level.emplace_back();
        std::transform(sums.begin(), sums.end(), std::back_inserter(cells), finish);
        sums = size > 1 ? sum_quarters(sums, size) : std::vector<CellSum>();
    }
    std::reverse(pyramid.level.begin(), pyramid.level.end());
    return pyramid;
}

// D(theta / 2) max(0, cos theta) up to a factor, at most 1.
float lobe(float alpha_squared, Vec3 r, Vec3 w) {
    const Vec3 chord = r - w;
    // sin^2(theta / 2) = chord^2 / 4, without the cancellation in 1 - cos theta.
    const float sine_squared = 0.25f * dot(chord, chord);
    const float cosine = 1 - 2 * sine_squared;
    if (!(cosine > 0)) return 0;
    const float ratio = alpha_squared / (alpha_squared * (1 - sine_squared) + sine_squared);
    return cosine * ratio * ratio;
}

struct Sum {
    Double3 flux{};
    double weight = 0;
};

// Cells are divided while they are large beside the distance over which the lobe changes, which is
// alpha at its peak and half the angle away from it. Half of it is small enough, since both sums
// err alike and light counts where it is (tested against the plain sum); cells of an eighth of a
// face or more are always divided, for the widest lobes.
void add_cell(const Pyramid& pyramid, float alpha_squared, Vec3 r, std::size_t level,
              std::size_t row, std::size_t column, Sum& sum) {
    const std::size_t size = std::size_t{1} << level;
    const Cell& cell = pyramid.level[level][row * size + column];
    const Vec3 chord = r - cell.centre;
    const float away = dot(chord, chord);                   // squared
    const float radius = 1.42f / static_cast<float>(size);  // half the diagonal
    if (1 - 0.5f * away < -radius) return;                  // all of it behind the horizon of r
    if (level + 1 < pyramid.level.size() &&
        (level < 3 || radius * radius > 0.25f * (alpha_squared + 0.25f * away))) {
        for (const std::size_t i : {0u, 1u, 2u, 3u}) {
            add_cell(pyramid, alpha_squared, r, level + 1, 2 * row + i / 2, 2 * column + i % 2,
                     sum);
        }
        return;
    }
    add(sum.flux, static_cast<double>(lobe(alpha_squared, r, cell.flux_centre)), cell.flux);
    sum.weight += static_cast<double>(lobe(alpha_squared, r, cell.centre) * cell.solid_angle);
}

float storable(double radiance) {
    return static_cast<float>(std::min(radiance, 1e35));
}

Environment convolve(const Pyramid& pyramid, double alpha, unsigned threads) {
    const std::uint32_t n = 1u << (pyramid.level.size() - 1);
    const double widened = std::max(alpha, 1.0 / n);  // no lobe narrower than a texel
    std::uint32_t size = 16;                          // two texels across half the lobe's width
    while (size < n && size < 2 / widened) {
        size *= 2;
    }
    Environment map;
    map.layout = Environment::Layout::cube;
    map.width = size;
    map.height = formats::kCubeFaces * size;
    map.pixel.resize(formats::cubemap_texels(size));
    for_ranges(map.height, 4, threads, [&](std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t j = begin * size; j < end * size; ++j) {
            const Vec3 r =
                formats::texel_direction(size, j / (size * size), j / size % size, j % size);
            Sum sum;
            for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
                add_cell(pyramid, static_cast<float>(widened * widened), r, 0, face, 0, sum);
            }
            map.pixel[j] = {storable(sum.flux[0] / sum.weight), storable(sum.flux[1] / sum.weight),
                            storable(sum.flux[2] / sum.weight)};
        }
    });
    return map;
}

double alpha_of(std::uint32_t level) {
    const double roughness = static_cast<double>(level) / kRoughnessSteps;
    return roughness * roughness;
}

}  // namespace

SpecularLight prefilter_specular(const Environment& environment,
                                 std::span<const std::uint32_t> levels, const Rotation& rotation,
                                 unsigned threads) {
    SpecularLight light{{}, rotation};
    if (levels.empty()) return light;
    const double sharpest = alpha_of(*std::min_element(levels.begin(), levels.end()));
    const std::uint32_t n = sharpest < 0.03 ? 128 : sharpest < 0.12 ? 64 : 32;
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    integrate_map(environment, n, {}, threads, integral);
    integrate_discs(environment.discs, n, {}, integral);
    const Pyramid pyramid = make_pyramid(integral, n);
    for (const std::uint32_t level : levels) {
        light.maps.push_back({level, convolve(pyramid, alpha_of(level), threads)});
    }
    return light;
}

}  // namespace opaline::runtime
