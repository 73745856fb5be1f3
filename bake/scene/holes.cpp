#include "bake/scene/holes.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "formats/disjoint_sets.h"

namespace opaline::bake {
namespace {

using Edge = std::pair<std::uint32_t, std::uint32_t>;

// Those where an odd number of triangles meet.
std::vector<Edge> find_open_edges(const BodyShells& body) {
    std::vector<Edge> edges, open;
    for (const BodyTriangle& t : body.triangle) {
        for (std::size_t k = 0; k < 3; ++k) {
            edges.push_back(std::minmax({t.point[k], t.point[(k + 1) % 3]}));
        }
    }
    std::ranges::sort(edges);
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        while (end < edges.size() && edges[end] == edges[i]) {
            ++end;
        }
        if ((end - i) % 2 == 1) {
            open.push_back(edges[i]);
        }
    }
    return open;
}

}  // namespace

double bound_hole_area(const BodyShells& body) {
    if (body.open_edges == 0) return 0;
    const std::vector<Edge> open = find_open_edges(body);
    formats::DisjointSets border(body.position.size());
    for (const Edge& edge : open) {
        border.join(edge.first, edge.second);
    }
    std::vector<double> length(body.position.size());  // [m] of the border with that name
    for (const Edge& edge : open) {
        length[border.find(edge.first)] += glm::distance(glm::dvec3(body.position[edge.first]),
                                                         glm::dvec3(body.position[edge.second]));
    }
    return std::inner_product(length.begin(), length.end(), length.begin(), 0.0) /
           (4 * std::numbers::pi);
}

}  // namespace opaline::bake
