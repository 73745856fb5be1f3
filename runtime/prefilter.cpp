// SpecularLight: the environment, convolved.

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_quadtree.h"
#include "runtime/parallel.h"
#include "runtime/specular.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;

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
void add_cell(const LightQuadtree& tree, float alpha_squared, Vec3 r, std::size_t level,
              std::size_t row, std::size_t column, Sum& sum) {
    const std::size_t size = std::size_t{1} << level;
    const LightCell& cell = tree.level[level][row * size + column];
    const Vec3 chord = r - cell.centre;
    const float away = dot(chord, chord);                   // squared
    const float radius = 1.42f / static_cast<float>(size);  // half the diagonal
    if (1 - 0.5f * away < -radius) return;                  // all of it behind the horizon of r
    if (level + 1 < tree.level.size() &&
        (level < 3 || radius * radius > 0.25f * (alpha_squared + 0.25f * away))) {
        for (const std::size_t i : {0u, 1u, 2u, 3u}) {
            add_cell(tree, alpha_squared, r, level + 1, 2 * row + i / 2, 2 * column + i % 2, sum);
        }
        return;
    }
    add(sum.flux, static_cast<double>(lobe(alpha_squared, r, cell.flux_centre)), cell.flux);
    sum.weight += static_cast<double>(lobe(alpha_squared, r, cell.centre) * cell.solid_angle);
}

float storable(double radiance) {
    return static_cast<float>(std::min(radiance, 1e35));
}

Environment convolve(const LightQuadtree& tree, double alpha, unsigned threads) {
    const std::uint32_t n = 1u << (tree.level.size() - 1);
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
                add_cell(tree, static_cast<float>(widened * widened), r, 0, face, 0, sum);
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
    SpecularLight light;
    light.rotation = rotation;
    if (levels.empty()) return light;
    const double sharpest = alpha_of(*std::min_element(levels.begin(), levels.end()));
    const std::uint32_t n = sharpest < 0.03 ? 128 : sharpest < 0.12 ? 64 : 32;
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(n));
    integrate_map(environment, n, {}, threads, integral);
    integrate_discs(environment.discs, n, {}, integral);
    const LightQuadtree tree = make_light_quadtree(integral, n);
    for (const std::uint32_t level : levels) {
        light.maps.push_back({level, convolve(tree, alpha_of(level), threads)});
    }
    return light;
}

}  // namespace opaline::runtime
