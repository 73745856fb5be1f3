#include "bake/exchange/particle_cells.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

double largest_of(const glm::dvec3& c) {
    return std::max({c.x, c.y, c.z});
}

// Sums over the cells of a node.
struct NodeSums {
    double by_points = 0, by_particles = 0;  // [lm]
};

}  // namespace

CellsOfElements::CellsOfElements(const formats::Scene& scene, const BounceTree& tree,
                                 std::size_t scatterers, const ElementLayout& layout)
    : scatterers_(scatterers) {
    const auto cell_of = [&](const ElementPlace& at, bool behind, const glm::vec3& normal) {
        const std::uint32_t node = tree.find(at.position, {at.material, behind, normal}, 0);
        return node == formats::kNone ? formats::kNone : tree.scatterer_of(node);
    };
    for (const ElementPlace& at : layout.places(scene)) {
        area_.push_back(at.area);
        front_.push_back(cell_of(at, at.is_back, at.normal));
        beyond_.push_back(scene.materials[at.material].sheet ? cell_of(at, !at.is_back, -at.normal)
                                                             : formats::kNone);
    }
}

ParticleCells CellsOfElements::sum(std::span<const ElementDeposit> deposits) const {
    ParticleCells cells;
    const auto sum_on = [&](std::span<const std::uint32_t> cell_of) {
        std::vector<ParticleCell> sums(scatterers_);
        for (std::size_t e = 0; e < deposits.size(); ++e) {
            if (cell_of[e] == formats::kNone) continue;
            ParticleCell& cell = sums[cell_of[e]];
            cell.power += deposits[e].power;
            cell.weight += deposits[e].weight;
            cell.weight_squares += deposits[e].weight_squares;
            cell.area += double{area_[e]};
        }
        return sums;
    };
    cells.front = sum_on(front_);
    cells.beyond = sum_on(beyond_);
    return cells;
}

void correct_by_particles(const BounceTree& tree, std::span<const ParticleCell> cells,
                          std::span<glm::dvec3> irradiance) {
    // Standard errors by which both may differ; a share of the light for what is small of cells.
    constexpr double kErrors = 3, kShare = 0.05;
    double weight = 0, squares = 0;
    for (const ParticleCell& cell : cells) {
        weight += cell.weight;
        squares += cell.weight_squares;
    }
    if (!(weight > 0)) return;
    const double of_particle = squares / weight;
    std::vector<NodeSums> sums(tree.size());
    for (auto v = static_cast<std::uint32_t>(tree.size()); v-- > 0;) {
        const std::uint32_t second = tree.second_child(v);
        if (second != 0) {
            sums[v] = {sums[v + 1].by_points + sums[second].by_points,
                       sums[v + 1].by_particles + sums[second].by_particles};
        } else {
            const std::uint32_t i = tree.scatterer_of(v);
            sums[v] = {largest_of(irradiance[i]) * cells[i].area, cells[i].weight};
        }
    }
    std::vector<std::uint8_t> holds(tree.size());
    for (std::uint32_t v = 0; v < tree.size(); ++v) {
        const double most = std::max(sums[v].by_points, sums[v].by_particles);
        if (std::abs(sums[v].by_points - sums[v].by_particles) <=
            kErrors * std::sqrt(most * of_particle) + kShare * most) {
            holds[v] = 1;
        }
        if (const std::uint32_t second = tree.second_child(v); second != 0) {
            holds[v + 1] = holds[second] = holds[v];
        } else if (const std::uint32_t i = tree.scatterer_of(v);
                   holds[v] == 0 && cells[i].area > 0) {
            irradiance[i] = cells[i].power / cells[i].area;
        }
    }
}

}  // namespace opaline::bake
