#include "bake/effects/volumes/volume_paths.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/base/rng.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/physics/path_integral/quasi_path.h"
#include "bake/physics/path_integral/turn.h"
#include "bake/physics/phase.h"
#include "formats/opal/spherical_harmonics.h"
#include "formats/opal/volumes.h"

namespace opaline::bake {
namespace {

// Optical depths between nodes, at a point of one volume that has them.
struct DepthsAround {
    std::array<const std::uint16_t*, 8> depth{};
    std::array<float, 8> weight{};
    std::size_t stride = 0;  // codes from one band to the next; 0: all bands have these
    bool found = false;

    float attenuation(std::size_t band, std::size_t cell) const {
        float sum = 0;
        for (std::size_t i = 0; i < depth.size(); ++i) {
            sum += weight[i] * static_cast<float>(depth[i][band * stride + cell]);
        }
        return std::exp(-DepthTable::kStep * sum);
    }
};

// Light at a point is the same for all volumes: use the nodes of the first one there.
DepthsAround depths_around(const VolumeWalkSpace& walk, glm::vec3 at) {
    DepthsAround depths;
    depths.stride = walk.depths.bands == 1 ? 0 : walk.depths.cells;
    for (std::size_t v = 0; v < walk.lattices.size() && !depths.found; ++v) {
        const DensityVolume& own = walk.space.volumes[v];
        const NodesAround around = nodes_around(walk.lattices[v], own.to_index * at + own.offset);
        depths.found = around.found && std::ranges::none_of(around.node, [](std::uint32_t node) {
                           return node == formats::kNoNode;
                       });
        for (std::size_t i = 0; depths.found && i < around.node.size(); ++i) {
            depths.depth[i] = walk.depths.codes(walk.first[v] + around.node[i], 0);
            depths.weight[i] = around.weight[i];
        }
    }
    return depths;
}

// (2 l + 1) / (4 pi) P_l(cosine) for l below `count`.
void eval_degrees(double cosine, std::span<double> degree) {
    double before = 0, now = 1;
    for (std::size_t l = 0; l < degree.size(); ++l) {
        const auto order = static_cast<double>(l);
        degree[l] = (2 * order + 1) / (4 * std::numbers::pi) * now;
        const double next = ((2 * order + 1) * cosine * now - order * before) / (order + 1);
        before = now;
        now = next;
    }
}

// What one view's paths share.
struct View {
    const VolumePathSpace& space;
    VolumeMedium& medium;
    const MarchLimits& limits;
    glm::dvec3 position, onward;
    double ell_onward = 0;  // scattering depth of the ray
};

// Depths of one band, from the start of a path.
struct BandDepths {
    double ell = 0, absorption = 0;
};

// One path to one group of cells: light that is scattered for the last time on it, into `sum`.
// `degree`: eval_degrees of each cell of the group.
PathSteps follow_path(const View& view, const QuasiPath& path, const PathCells::Group& group,
                      std::span<const double> degree, double weight, std::span<float> sum) {
    const VolumeWalkSpace& walk = view.space.walk;
    const std::size_t bands = walk.space.bands(), degrees = view.space.lambda.size();
    std::array<BandDepths, 3> reached{};
    std::vector<double> moment(degrees);
    PathSteps steps = 0;
    const auto medium = [&](glm::dvec3 x) { return view.medium(x); };
    march_quasi_path(path, medium, view.limits, [&](const PathStep& step) {
        ++steps;
        if (step.depth <= 0) return true;
        const DepthsAround around = depths_around(walk, glm::vec3(step.position));
        double most = 0;
        for (std::size_t band = 0; band < bands; ++band) {
            const Coefficients here = view.medium.here()[band];
            const double depth = here.scattering * step.length;
            const double lost = here.absorption * step.length;
            BandDepths& at = reached[band];
            const double ell = at.ell + 0.5 * depth, absorption = at.absorption + 0.5 * lost;
            at = {at.ell + depth, at.absorption + lost};
            const double survival = std::exp(-absorption);
            most = std::max(most, survival);
            if (!around.found) continue;
            for (std::size_t l = 0; l < degrees; ++l) {
                moment[l] = weight * depth * survival * moment_of_source(view.space.lambda[l], ell);
            }
            for (std::size_t i = 0; i < group.cell.size(); ++i) {
                double kernel = 0;
                for (std::size_t l = 0; l < degrees; ++l) {
                    kernel += moment[l] * degree[i * degrees + l];
                }
                const std::size_t cell = group.cell[i];
                sum[band * walk.cells.size() + cell] +=
                    static_cast<float>(kernel) * around.attenuation(band, cell);
            }
        }
        return most > kLeastSurvival;
    });
    return steps;
}

PathSteps add_group(const View& view, const PathCells::Group& group, std::span<float> sum) {
    const std::size_t degrees = view.space.lambda.size();
    std::vector<double> degree(group.cell.size() * degrees);
    for (std::size_t i = 0; i < group.cell.size(); ++i) {
        const glm::dvec3 light(view.space.walk.cells.direction(group.cell[i]));
        eval_degrees(glm::dot(view.onward, light), std::span(degree).subspan(i * degrees, degrees));
    }
    const Turns turns(view.onward, group.middle);
    const double weight = 1.0 / static_cast<double>(view.space.lengths.size() * turns.size());
    PathSteps steps = 0;
    for (const double length : view.space.lengths) {
        for (const Turn& turn : turns) {
            const double ell_total = std::max(length * view.ell_onward, kShortestTurn);
            steps +=
                follow_path(view, {view.position, turn, ell_total}, group, degree, weight, sum);
        }
    }
    return steps;
}

}  // namespace

PathCells group_cells(const LightCells& cells) {
    PathCells groups;
    const std::uint32_t n = cells.n, block = n >= 2 ? 2 : 1;
    if (n < 2) {
        for (std::uint32_t cell = 0; cell < cells.size(); ++cell) {
            groups.group.push_back({glm::normalize(glm::dvec3(cells.direction(cell))), {cell}});
        }
        return groups;
    }
    for (std::uint32_t first = 0; first < cells.size(); first += n * block) {
        for (std::uint32_t column = 0; column < n; column += block) {
            PathCells::Group group;
            glm::dvec3 sum(0);
            for (std::uint32_t i = 0; i < block * block; ++i) {
                group.cell.push_back(first + i / block * n + column + i % block);
                sum += glm::dvec3(cells.direction(group.cell.back()));
            }
            group.middle = glm::normalize(sum);
            groups.group.push_back(std::move(group));
        }
    }
    return groups;
}

double path_step_length(const formats::SparseGrid<float>& grid, std::uint32_t spacing) {
    const double edge = std::min({glm::length(grid.to_scene[0]), glm::length(grid.to_scene[1]),
                                  glm::length(grid.to_scene[2])});
    return edge * std::max(1.0, 0.5 * spacing);
}

std::span<const double> path_lengths(Quality quality) {
    static constexpr std::array<double, 3> kLengths{1, 0.5, 2};
    return std::span(kLengths).first(quality < Quality::production ? 1 : 3);
}

PathSteps add_path_light(const VolumePathSpace& space, glm::vec3 position, glm::vec3 onward,
                         std::span<float> sum) {
    VolumeMedium medium(space.walk.space);
    double step = std::numeric_limits<double>::infinity();
    for (std::size_t v = 0; v < space.walk.lattices.size(); ++v) {
        step = std::min(step, path_step_length(*space.walk.space.volumes[v].grid,
                                               space.walk.lattices[v].spacing));
    }
    const MarchLimits limits{box_of(space.walk.space), step};
    View view{space, medium, limits, position, glm::normalize(glm::dvec3(onward))};
    view.ell_onward = probe_depth([&](glm::dvec3 x) { return medium(x).scattering; }, limits.box,
                                  view.position, view.onward, limits.step);
    PathSteps steps = 0;
    for (const PathCells::Group& group : space.groups.group) {
        steps += add_group(view, group, sum);
    }
    return steps;
}

PathSteps gather_paths(const VolumePathSpace& space, const PathReceiver& receiver,
                       std::span<float> out) {
    const std::size_t row = space.walk.space.bands() * space.walk.cells.size();
    std::ranges::fill(out, 0.0f);
    std::vector<float> sum(row);
    std::array<float, formats::kMaxHarmonics> view{1};
    const auto turn = random_uniform(space.walk.seed, RandomStage::volume_walk, receiver.node);
    PathSteps steps = 0;
    for (std::uint32_t i = 0; i < receiver.views; ++i) {
        const glm::vec3 onward = even_direction(i, receiver.views, turn[0], turn[1]);
        std::ranges::fill(sum, 0.0f);
        steps += add_path_light(space, receiver.position, onward, sum);
        if (receiver.terms > 1) {
            // Toward the eye.
            formats::eval_spherical_harmonics({-onward.x, -onward.y, -onward.z},
                                              std::span(view).first(receiver.terms));
        }
        const float share = (receiver.terms == 1 ? 1.0f : 4 * std::numbers::pi_v<float>) /
                            static_cast<float>(receiver.views);
        for (std::uint32_t k = 0; k < receiver.terms; ++k) {
            for (std::size_t j = 0; j < row; ++j) {
                out[k * row + j] += share * view[k] * sum[j];
            }
        }
    }
    return steps;
}

}  // namespace opaline::bake
