#include "bake/effects/volumes/choose_method.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_work.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kCompared = 24;  // nodes

PlanEntry* find_often(std::span<PlanEntry> entries, std::uint32_t volume) {
    const auto found = std::ranges::find_if(entries, [&](const PlanEntry& entry) {
        return entry.on && entry.name == kOftenInVolumes && entry.subject.index == volume;
    });
    return found == entries.end() ? nullptr : &*found;
}

std::string rows_text(std::uint32_t terms) {
    return std::to_string(terms) + (terms == 1 ? " row a node" : " rows a node");
}

std::string percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2g %%", 100 * share);
    return text;
}

bool same_phase(const ScaledPhase& a, const ScaledPhase& b) {
    return a.degree == b.degree && a.peak == b.peak && a.lambda == b.lambda;
}

// Of `auto`, from counts alone.
VolumeMethod choose_by_work(const VolumeWork& work, double& times) {
    const double walks = count_walk_scatterings(work), paths = count_path_scatterings(work);
    times = walks > 0 ? paths / walks : 0;
    return paths < walks ? VolumeMethod::automatic : VolumeMethod::walks;
}

}  // namespace

bool share_phase(const formats::Scene& scene) {
    return std::ranges::all_of(scene.volumes, [&](const formats::Volume& volume) {
        return same_phase(scale_phase(volume.phase), scale_phase(scene.volumes.front().phase));
    });
}

double method_budget(const Knobs& knobs) {
    constexpr std::array<double, 4> kBudget{0.2, 0.1, 0.05, 0};
    return knobs.error_target > 0 ? 0.5 * knobs.error_target
                                  : kBudget[static_cast<std::size_t>(knobs.quality)];
}

void plan_methods(const formats::Scene& scene, const Knobs& knobs, std::span<VolumeLayout> layouts,
                  std::span<PlanEntry> entries) {
    const auto asked = static_cast<VolumeMethod>(whole(knobs, kVolumeMethod));
    const bool can_integrate = share_phase(scene);
    std::vector<VolumeWork> works;
    if (asked == VolumeMethod::automatic && can_integrate && method_budget(knobs) > 0) {
        works = count_volume_work(scene, layouts, knobs);
    }
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        VolumeLayout& layout = layouts[i];
        PlanEntry* const entry = find_often(entries, layout.volume);
        layout.method = VolumeMethod::walks;
        if (layout.often_terms == 0 || entry == nullptr) continue;
        std::string why = "random walks";
        if (asked == VolumeMethod::path_integration && !can_integrate) {
            why =
                "random walks: volumes differ in their phase functions, of which path "
                "integration knows one";
        } else if (asked != VolumeMethod::automatic) {
            layout.method = asked;
            why = asked == VolumeMethod::walks ? "random walks, as --volume-method says"
                                               : "path integration, as --volume-method says";
        } else if (layout.sees_surfaces) {
            why = "random walks, which find the light of surfaces too";
        } else if (!works.empty()) {
            double times = 0;
            layout.method = choose_by_work(works[i], times);
            if (layout.method == VolumeMethod::walks) {
                char text[96];
                std::snprintf(text, sizeof text,
                              "random walks: paths would take %.2g times the work", times);
                why = times > 1.05 ? text : "random walks, which take no more work than paths";
            } else {
                why = "path integration if the bake measures at most " +
                      percent(method_budget(knobs)) + " of error, else random walks";
            }
        }
        entry->choice = layout.method == VolumeMethod::automatic ? "" : name_of(layout.method);
        entry->reason =
            "light is scattered more than once: " + why + ", " + rows_text(layout.often_terms);
    }
}

MethodMeasure compare_methods(std::span<const NodeComparison> nodes) {
    double error = 0, noise = 0, light = 0;
    for (const NodeComparison& node : nodes) {
        for (std::size_t i = 0; i < node.paths.size(); ++i) {
            const auto p = static_cast<double>(node.paths[i]),
                       a = static_cast<double>(node.walks[i]),
                       b = static_cast<double>(node.others[i]);
            error += node.weight * (p - a) * (p - b);
            noise += node.weight * 0.5 * (a - b) * (a - b);
            light += node.weight * a * b;
        }
    }
    MethodMeasure measure;
    measure.nodes = static_cast<std::uint32_t>(nodes.size());
    if (light > 0) {
        measure.path_error = std::sqrt(std::max(error, 0.0) / light);
        measure.walk_noise = std::sqrt(noise / light);
    }
    return measure;
}

MethodMeasure measure_method(const VolumePathSpace& space, const formats::SparseGrid<float>& grid,
                             const VolumeLayout& layout, double budget) {
    const VolumeWalkSpace& walk = space.walk;
    const std::vector<glm::ivec3>& node = walk.lattices[layout.volume].node;
    const std::size_t count = std::min(node.size(), kCompared);
    const std::size_t size = layout.often_terms * walk.space.bands() * walk.cells.size();
    VolumeWalkSpace other = walk;
    other.seed = ~walk.seed;
    std::vector<NodeComparison> compared(count);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t own = (2 * i + 1) * node.size() / (2 * count);
        const std::size_t number = walk.first[layout.volume] + own;
        const glm::vec3 position(grid.to_scene * glm::dvec4(glm::dvec3(node[own]), 1.0));
        compared[i] = {std::vector<float>(size), std::vector<float>(size), std::vector<float>(size),
                       static_cast<double>(grid.sample(glm::vec3(node[own])))};
        gather_paths(space, {layout.volume, number, position, layout.views, layout.often_terms},
                     compared[i].paths);
        const WalkReceiver receiver{layout.volume,      number, position, layout.walks,
                                    layout.often_terms, true,   false};
        gather_walks(walk, receiver, compared[i].walks);
        gather_walks(other, receiver, compared[i].others);
    }
    MethodMeasure measure = compare_methods(compared);
    measure.volume = layout.whole;
    measure.method = measure.path_error <= budget && count > 0 ? VolumeMethod::path_integration
                                                               : VolumeMethod::walks;
    return measure;
}

void tell_method(const MethodMeasure& measure, double budget, std::span<PlanEntry> entries) {
    if (PlanEntry* const entry = find_often(entries, measure.volume)) {
        entry->choice = name_of(measure.method);
        entry->reason = "light is scattered more than once: " +
                        std::string(measure.method == VolumeMethod::walks ? "random walks"
                                                                          : "path integration") +
                        ", " + rows_text(entry->terms) + "; path integration measured at " +
                        percent(measure.path_error) + " of error at " +
                        std::to_string(measure.nodes) + " nodes, of which " + percent(budget) +
                        " fit; one node's walks at " + percent(measure.walk_noise) + " of noise";
    }
}

}  // namespace opaline::bake
