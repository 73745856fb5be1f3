#include "runtime/light_quadtree.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/cubemap.h"
#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

// Squares of what floats held fit into doubles: no need of hypot, which takes longer.
double norm_of(const Double3& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

Vec3 unit(const Double3& v, Vec3 otherwise) {
    const double norm = norm_of(v);
    if (!(norm > 0) || !std::isfinite(norm)) return otherwise;
    return {static_cast<float>(v[0] / norm), static_cast<float>(v[1] / norm),
            static_cast<float>(v[2] / norm)};
}

double luminance(const Double3& c) {
    return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2];
}

// 1 - |moment / weight|^2; 0 where there is no weight.
float spread(const Double3& moment, double weight) {
    if (!(weight > 0) || !std::isfinite(weight)) return 0;
    const double mean = norm_of(moment) / weight;
    return static_cast<float>(std::clamp(1 - mean * mean, 0.0, 1.0));
}

// What a cell is made from: its first moments, before they are normalised.
struct CellSum {
    Double3 flux{}, moment{}, flux_moment{};
    double solid_angle = 0;
};

LightCell finish(const CellSum& sum) {
    LightCell cell;
    cell.flux = sum.flux;
    cell.solid_angle = static_cast<float>(sum.solid_angle);
    cell.centre = unit(sum.moment, {0, 0, 1});
    cell.flux_centre = unit(sum.flux_moment, cell.centre);
    cell.spread = spread(sum.moment, sum.solid_angle);
    cell.flux_spread = spread(sum.flux_moment, luminance(sum.flux));
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

}  // namespace

LightQuadtree make_light_quadtree(std::span<const double> integral, std::uint32_t n,
                                  unsigned threads) {
    LightQuadtree tree;
    std::vector<CellSum> sums = sum_texels(integral, n);
    for (std::uint32_t size = n; size > 0; size /= 2) {
        std::vector<LightCell>& cells = tree.level.emplace_back(sums.size());
        for_ranges(static_cast<std::uint32_t>(sums.size()), 4096, threads,
                   [&](std::uint32_t begin, std::uint32_t end) {
                       for (std::uint32_t j = begin; j < end; ++j) {
                           cells[j] = finish(sums[j]);
                       }
                   });
        sums = size > 1 ? sum_quarters(sums, size) : std::vector<CellSum>();
    }
    std::reverse(tree.level.begin(), tree.level.end());
    return tree;
}

}  // namespace opaline::runtime
