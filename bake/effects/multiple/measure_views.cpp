#include "bake/effects/multiple/measure_views.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/multiple/measure_models.h"
#include "bake/effects/multiple/rule_layers.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/walks/true_walks.h"
#include "bake/effects/multiple/walks/view_set.h"

namespace opaline::bake {
namespace {

// Sums over receivers, views and lights; a product of two independent estimates has no noise on
// average.
struct ViewSquares {
    double one = 0, truth = 0;
};

// `seen`: of each view.
ViewSquares compare_views(const ViewSet& set, const std::vector<TwoEstimates>& seen) {
    constexpr double kNormal = 0.25;  // weight of the last view, the normal
    ViewSquares squares;
    for (std::size_t u = 0; u < seen.size(); ++u) {
        const double weight =
            u + 1 == seen.size() ? kNormal : (1 - kNormal) * static_cast<double>(set.share[u][0]);
        for (std::size_t l = 0; l < seen[u].first.size(); ++l) {
            const auto left = [&](Luminance TwoEstimates::*by) {
                double sum = -(seen[u].*by)[l];
                for (std::size_t v = 0; v < seen.size(); ++v) {
                    sum += static_cast<double>(set.share[v][0]) * (seen[v].*by)[l];
                }
                return sum;
            };
            squares.one += weight * left(&TwoEstimates::first) * left(&TwoEstimates::second);
            squares.truth += weight * seen[u].first[l] * seen[u].second[l];
        }
    }
    return squares;
}

}  // namespace

ViewErrors measure_views(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced) {
    constexpr std::size_t kReceivers = 16;
    constexpr std::uint32_t kFromEach = 32, kRaysPerSun = 1;
    const std::vector<BodyPoint> points = draw_body_points(inputs, kReceivers);
    const std::vector<TestLight> lights = make_pilot_lights();
    const SunRays suns = make_sun_rays(lights, kRaysPerSun);
    const SmoothLights smooth = make_smooth_lights(lights);
    const WalkSpace space =
        make_walk_space(inputs.bake.scene, inputs.bake.rays.hierarchy(), inputs.material,
                        inputs.layout.bands() == 1, inner_materials(inputs));
    const ViewFit fit = make_view_fit(profile.eta);
    struct Part {
        ViewSquares squares;
        std::uint64_t rays = 0;
    };
    ViewSquares sum;
    for_each_block_in_order(
        points.size(), 1, inputs.context,
        [&](Range range) {
            Part part;
            const BodyPoint& point = points[range.begin];
            const ViewSet set = make_view_set(fit, profile.eta, point.normal, 1 + kFirstDegree);
            std::vector<TwoEstimates> seen;
            for (const glm::vec3& into : set.into) {
                const WalkLight light{
                    inputs.outside(), suns,      smooth, make_exit_lobe(profile.eta),
                    profile.exit,     kFromEach, -into};
                const auto key =
                    static_cast<std::uint32_t>(range.begin * set.into.size() + seen.size());
                seen.push_back(walk_to_lights(space, light, point,
                                              {1, false, inputs.layout.fills_crossed},
                                              inputs.knobs.seed, key, part.rays));
            }
            part.squares = compare_views(set, seen);
            return part;
        },
        [&](Range, Part&& part) {
            sum.one += part.squares.one;
            sum.truth += part.squares.truth;
            traced += part.rays;
        });
    if (!(sum.truth > 0)) {
        return {};
    }
    const auto above_noise = [&](double squares) {
        constexpr double kNoise = 0.03;
        const double error = std::sqrt(std::max(0.0, squares / sum.truth));
        return error > kNoise ? error : 0;
    };
    return {above_noise(sum.one), static_cast<std::uint32_t>(points.size())};
}

}  // namespace opaline::bake
