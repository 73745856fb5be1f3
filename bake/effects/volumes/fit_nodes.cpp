#include "bake/effects/volumes/fit_nodes.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "bake/effects/volumes/walk_parts.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

// What flows from each node of a line to the next one: (c_i+1 - c_i) / 6 of the solution c, which
// is found by elimination. `means`: b_i.
std::vector<glm::vec3> flows_along(std::vector<glm::vec3> means) {
    const std::size_t last = means.size() - 1;
    std::vector<float> share(means.size());  // of c_i+1 in c_i
    for (std::size_t i = 1; i < last; ++i) {
        share[i] = 1 / (4 - share[i - 1]);
        means[i] = share[i] * (6.0f * means[i] - means[i - 1]);
    }
    for (std::size_t i = last - 1; i > 0; --i) {
        means[i] -= share[i] * means[i + 1];
    }
    std::vector<glm::vec3> flows(last);
    for (std::size_t i = 0; i < last; ++i) {
        flows[i] = (means[i + 1] - means[i]) / 6.0f;
    }
    return flows;
}

// Which share of what flows out of a node may do so, that something is left in every band. `to`:
// what flows to the next node; `from`: from the one before.
float most_outflow(glm::vec3 own, glm::vec3 from, glm::vec3 to) {
    constexpr float kLeft = 0.1f;
    float share = 1;
    for (int band = 0; band < 3; ++band) {
        const float lost = std::max(to[band], 0.0f) + std::max(-from[band], 0.0f);
        const float most = (1 - kLeft) * std::max(own[band], 0.0f);
        if (lost > most) share = std::min(share, most / lost);
    }
    return share;
}

// Along one line, with the ends left as they are.
void fit_line(const NodeLine& line, std::size_t terms, std::span<glm::vec3> values) {
    const std::size_t last = line.size() - 1;
    std::vector<std::vector<glm::vec3>> flows;  // of each term
    for (std::size_t term = 0; term < terms; ++term) {
        std::vector<glm::vec3> means;
        for (const std::uint32_t node : line) {
            means.push_back(values[node * terms + term]);
        }
        flows.push_back(flows_along(std::move(means)));
    }
    std::vector<float> most(line.size(), 1);
    for (std::size_t i = 1; i < last; ++i) {
        most[i] = most_outflow(values[line[i] * terms], flows[0][i - 1], flows[0][i]);
    }
    for (std::size_t i = 0; i < last; ++i) {
        // All terms and bands alike, by what either node can give.
        const float share = std::min(most[i], most[i + 1]);
        for (std::size_t term = 0; term < terms; ++term) {
            const glm::vec3 flow = share * flows[term][i];
            if (i > 0) values[line[i] * terms + term] -= flow;
            if (i + 1 < last) values[line[i + 1] * terms + term] += flow;
        }
    }
}

}  // namespace

std::array<std::vector<NodeLine>, 3> find_node_lines(const NodeLattice& lattice,
                                                     const glm::dmat4& to_scene,
                                                     const RayScene& surfaces,
                                                     std::uint64_t& rays) {
    std::map<std::tuple<int, int, int>, std::uint32_t> number;
    for (std::uint32_t i = 0; i < lattice.node.size(); ++i) {
        const glm::ivec3 at = lattice.node[i];
        number.emplace(std::tuple(at.x, at.y, at.z), i);
    }
    std::array<std::vector<NodeLine>, 3> lines;
    for (int axis = 0; axis < 3; ++axis) {
        glm::ivec3 step(0);
        step[axis] = static_cast<int>(lattice.spacing);
        const glm::vec3 way(to_scene * glm::dvec4(glm::dvec3(step), 0));
        const float length = glm::length(way);
        // The next node, or none behind a surface.
        const auto next_of = [&](glm::ivec3 at) {
            const glm::ivec3 to = at + step;
            const auto found = number.find({to.x, to.y, to.z});
            if (found == number.end()) return formats::kNoNode;
            const glm::vec3 from(to_scene * glm::dvec4(glm::dvec3(at), 1));
            return find_surface(surfaces, from, way / length, rays).distance > length
                       ? found->second
                       : formats::kNoNode;
        };
        std::vector<std::uint32_t> next(lattice.node.size());
        std::vector<char> is_first(lattice.node.size(), 1);
        for (std::size_t i = 0; i < next.size(); ++i) {
            next[i] = next_of(lattice.node[i]);
            if (next[i] != formats::kNoNode) is_first[next[i]] = 0;
        }
        for (std::uint32_t i = 0; i < next.size(); ++i) {
            if (is_first[i] == 0) continue;
            NodeLine line;
            for (std::uint32_t n = i; n != formats::kNoNode; n = next[n]) {
                line.push_back(n);
            }
            if (line.size() > 2) lines[static_cast<std::size_t>(axis)].push_back(std::move(line));
        }
    }
    return lines;
}

void fit_tent_means(const std::array<std::vector<NodeLine>, 3>& lines, std::size_t terms,
                    std::span<glm::vec3> values) {
    for (const std::vector<NodeLine>& along : lines) {
        for (const NodeLine& line : along) {
            fit_line(line, terms, values);
        }
    }
}

}  // namespace opaline::bake
