#include "bake/receivers/eliminate_crowded.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/point_grid.h"

namespace opaline::bake {
namespace {

struct Neighbour {
    std::uint32_t point;
    float crowding;
};

// For every point, its neighbours within a radius on the same side.
struct Neighbours {
    std::vector<std::size_t> begin, end;  // into `list`
    std::vector<Neighbour> list;

    std::span<const Neighbour> of(std::uint32_t i) const {
        return std::span(list).subspan(begin[i], end[i] - begin[i]);
    }
};

Neighbours find_neighbours(const std::vector<SurfacePoint>& points, float radius,
                           const Context& context) {
    const PointGrid grid(points, radius);
    Neighbours all;
    all.begin.resize(points.size());
    all.end.resize(points.size());
    struct Part {
        std::vector<std::uint32_t> count;
        std::vector<Neighbour> list;
    };
    for_each_block_in_order(
        grid.cells(), 256, context,
        [&](Range range) {
            Part part;
            std::vector<std::uint32_t> around;
            for (std::size_t cell = range.begin; cell < range.end; ++cell) {
                grid.collect_around(grid.name_of(cell), around);
                for (const std::uint32_t i : grid.points_in(cell)) {
                    const std::size_t before = part.list.size();
                    for (const std::uint32_t j : around) {
                        const float d = glm::distance(points[i].position, points[j].position);
                        if (j != i && d < radius &&
                            on_same_side(points[i].normal, points[j].normal)) {
                            const float x = 1.0f - d / radius, x2 = x * x, x4 = x2 * x2;
                            part.list.push_back({j, x4 * x4});
                        }
                    }
                    part.count.push_back(static_cast<std::uint32_t>(part.list.size() - before));
                }
            }
            return part;
        },
        [&](Range range, const Part& part) {
            std::size_t at = all.list.size();
            auto count = part.count.begin();
            for (std::size_t cell = range.begin; cell < range.end; ++cell) {
                for (const std::uint32_t i : grid.points_in(cell)) {
                    all.begin[i] = at;
                    all.end[i] = at += *count++;
                }
            }
            all.list.insert(all.list.end(), part.list.begin(), part.list.end());
        });
    return all;
}

// Removes the most crowded points until `count` are left. Points whose crowding differs by a few
// per cent go in any order: the exact order needs a heap, which costs more than all the rest.
std::vector<std::uint32_t> thin_out(const Neighbours& neighbours, std::vector<double> weight,
                                    std::size_t count) {
    std::vector<std::uint32_t> left(weight.size());
    std::iota(left.begin(), left.end(), 0u);
    std::vector<bool> alive(weight.size(), true);
    constexpr double kStep = 0.98, kAlone = 1e-6;
    double limit = weight.empty() ? 0 : *std::max_element(weight.begin(), weight.end());
    std::size_t surplus = left.size() - std::min(count, left.size());
    while (surplus > 0) {
        limit = limit > kAlone ? kStep * limit : -1;
        for (const std::uint32_t i : left) {
            if (surplus == 0) {
                break;
            }
            if (weight[i] <= limit) {
                continue;
            }
            alive[i] = false;
            --surplus;
            for (const Neighbour& n : neighbours.of(i)) {
                weight[n.point] -= static_cast<double>(n.crowding);
            }
        }
        std::erase_if(left, [&](std::uint32_t i) { return !alive[i]; });
    }
    return left;
}

}  // namespace

std::vector<std::uint32_t> eliminate_crowded(const std::vector<SurfacePoint>& points,
                                             std::size_t count, double area,
                                             const Context& context) {
    const double r_max = std::sqrt(area / (2.0 * std::sqrt(3.0) * static_cast<double>(count)));
    const Neighbours neighbours = find_neighbours(points, static_cast<float>(2.0 * r_max), context);
    std::vector<double> weight(points.size(), 0.0);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        for (const Neighbour& n : neighbours.of(i)) {
            weight[i] += static_cast<double>(n.crowding);
        }
    }
    return thin_out(neighbours, std::move(weight), count);
}

}  // namespace opaline::bake
