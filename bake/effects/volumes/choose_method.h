#pragma once

#include <span>
#include <string>
#include <vector>

#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_paths.h"
#include "bake/plan/bake_plan.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether path integration can be taken: all volumes have the same phase function, because the law
/// of directions along a path is that of one.
bool share_phase(const formats::Scene& scene);

/// Decides each layout's method without tracing rays: the one of `--volume-method`, or with `auto`
/// walks where they take no more work than paths, by count; else VolumeMethod::automatic, which
/// `measure_method` resolves. Entries are those of plan_volumes; the ones of light scattered more
/// than once get choices and reasons.
void plan_methods(const formats::Scene& scene, const Knobs& knobs, std::span<VolumeLayout> layouts,
                  std::span<PlanEntry> entries);

/// Largest relative error that path integration may have: half of a target error, or 0.2, 0.1,
/// 0.05 and 0 by quality, draft to reference.
double method_budget(const Knobs& knobs);

/// Difference between the rows of both methods, and noise of walks: squares relative to those of
/// the light itself, over all views, directions of light and bands, and over nodes by density.
struct MethodMeasure {
    std::uint32_t volume = 0;
    VolumeMethod method = VolumeMethod::walks;  ///< that was taken
    double path_error = 0;                      ///< relative RMS of path integration; >= 0
    double walk_noise = 0;                      ///< relative RMS of the walks of one node
    std::uint32_t nodes = 0;                    ///< compared

    bool operator==(const MethodMeasure&) const = default;
};

/// Rows of one node, as gather_walks returns them: by paths, and by walks of two independent sets.
struct NodeComparison {
    std::vector<float> paths, walks, others;
    double weight = 1;  ///< of its squares: the density there, as rays see it
};

/// Both noises are independent, so that with p, a and b of `nodes` the mean of (p - a)(p - b) is
/// the square of the paths' error, of (a - b)^2 / 2 that of the noise, and of a b that of the
/// light, all without bias.
MethodMeasure compare_methods(std::span<const NodeComparison> nodes);

/// Compares both ways at 24 nodes of a layout, and takes paths if their error is at most `budget`.
MethodMeasure measure_method(const VolumePathSpace& space, const formats::SparseGrid<float>& grid,
                             const VolumeLayout& layout, double budget);

/// The decision in words, into the layout's entry.
void tell_method(const MethodMeasure& measure, double budget, std::span<PlanEntry> entries);

}  // namespace opaline::bake
