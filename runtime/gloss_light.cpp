#include "runtime/gloss_light.h"

#include <algorithm>
#include <numbers>
#include <queue>

#include "formats/opal/cubemap.h"
#include "runtime/integrate_discs.h"
#include "runtime/integrate_map.h"
#include "runtime/light_quadtree.h"

namespace opaline::runtime {
namespace {

using formats::Environment;

float storable(double value) {
    return static_cast<float>(std::clamp(value, 0.0, 1e35));
}

Environment mean_radiance(const std::vector<LightCell>& cells, std::uint32_t n) {
    Environment map;
    map.layout = Environment::Layout::cube;
    map.width = n;
    map.height = formats::kCubeFaces * n;
    map.pixel.reserve(cells.size());
    for (const LightCell& cell : cells) {
        const double share = 1 / static_cast<double>(cell.solid_angle);
        map.pixel.push_back({storable(share * cell.flux[0]), storable(share * cell.flux[1]),
                             storable(share * cell.flux[2])});
    }
    return map;
}

double brightness(const LightCell& cell) {
    return cell.flux[0] + cell.flux[1] + cell.flux[2];
}

// A cell that may be divided further.
struct Candidate {
    double error = 0;
    std::size_t level = 0, number = 0;

    friend bool operator<(const Candidate& a, const Candidate& b) {
        return a.error != b.error   ? a.error < b.error
               : a.level != b.level ? a.level > b.level
                                    : a.number > b.number;
    }
};

void append(GlossLight::Cells& cells, const LightCell& cell) {
    const bool has_light = brightness(cell) > 0;
    const formats::Vec3 at = has_light ? cell.flux_centre : cell.centre;
    cells.x.push_back(at.x);
    cells.y.push_back(at.y);
    cells.z.push_back(at.z);
    cells.solid_angle.push_back(cell.solid_angle);
    // A disc of radius rho has a spread of rho^2 / 2 and adds rho^2 / 16, a quarter of what a sun
    // adds: the lobes of neighbouring cells overlap. The least error of those tried.
    cells.widening.push_back(0.125f * (has_light ? cell.flux_spread : cell.spread));
    cells.r.push_back(storable(cell.flux[0]));
    cells.g.push_back(storable(cell.flux[1]));
    cells.b.push_back(storable(cell.flux[2]));
}

// Divides the cell whose size makes the largest error until there are as many as allowed. Dark
// cells count a little: they fix the share of the lobe that other cells stand for.
GlossLight::Cells divide_sphere(const LightQuadtree& tree) {
    constexpr double kDarkShare = 0.05;
    double total = 0;
    for (const LightCell& face : tree.level[0]) {
        total += brightness(face);
    }
    const double floor = (total > 0 ? kDarkShare * total : 1) / (4 * std::numbers::pi);
    std::priority_queue<Candidate> open;
    const auto push = [&](std::size_t level, std::size_t number) {
        const LightCell& cell = tree.level[level][number];
        const double light = brightness(cell) + floor * static_cast<double>(cell.solid_angle);
        const bool is_texel = level + 1 == tree.level.size();
        open.push({is_texel ? -1 : light * static_cast<double>(cell.spread), level, number});
    };
    for (std::size_t face = 0; face < formats::kCubeFaces; ++face) {
        push(0, face);
    }
    while (open.size() + 3 <= kLightCells && open.top().error >= 0) {
        const Candidate coarse = open.top();
        open.pop();
        const std::size_t n = std::size_t{1} << coarse.level;
        const std::size_t row = coarse.number / n, column = coarse.number % n;
        for (const std::size_t i : {0u, 1u, 2u, 3u}) {
            push(coarse.level + 1, (2 * row + i / 2) * 2 * n + 2 * column + i % 2);
        }
    }
    GlossLight::Cells cells;
    for (; !open.empty(); open.pop()) {
        append(cells, tree.level[open.top().level][open.top().number]);
    }
    LightCell nothing;
    nothing.centre = {0, 0, 1};
    while (cells.size() % kCellBlock != 0) {
        append(cells, nothing);
    }
    return cells;
}

}  // namespace

GlossLight make_gloss_light(std::span<const double> integral,
                            std::span<const formats::DistantDisc> discs, unsigned threads) {
    GlossLight light;
    std::vector<formats::DistantDisc> large;
    for (const formats::DistantDisc& disc : discs) {
        (disc.angular_radius <= kLargestSun ? light.suns : large).push_back(disc);
    }
    std::vector<double> sums(integral.begin(), integral.end());
    integrate_discs(large, kGlossTexels, {}, sums);
    const LightQuadtree tree = make_light_quadtree(sums, kGlossTexels, threads);
    for (std::size_t level = tree.level.size(); level-- > 0;) {
        light.map.push_back(mean_radiance(tree.level[level], 1u << level));
    }
    light.cells = divide_sphere(tree);
    return light;
}

GlossLight make_gloss_light(const Environment& environment, unsigned threads) {
    std::vector<double> integral(std::size_t{3} * formats::cubemap_texels(kGlossTexels));
    integrate_map(environment, kGlossTexels, {}, threads, integral);
    return make_gloss_light(integral, environment.discs, threads);
}

}  // namespace opaline::runtime
