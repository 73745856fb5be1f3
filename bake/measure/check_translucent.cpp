#include "bake/measure/check_translucent.h"

#include <string>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/stored_luminance.h"
#include "bake/plan/check_counts.h"

namespace opaline::bake {

MediumCheck make_medium_check(const formats::Scene& scene, const RayScene& rays,
                              const TranslucentRecipe& recipe, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const TestLight> lights) {
    const bool once = recipe.layout.single_terms > 0;
    return {scene,
            rays,
            recipe,
            material,
            make_translucent_truth(scene, material, recipe.profile, once ? 2 * depth_samples : 0,
                                   lights),
            0};
}

EffectCheck check_translucent(const MediumCheck& medium, const formats::AssetView& asset,
                              std::span<const CheckPoint> points, std::span<const TestLight> lights,
                              const Context& context) {
    EffectCheck check;
    const RowLayout& layout = medium.recipe.layout;
    if (medium.recipe.profile != nullptr) {
        check.effect = "multiple";
        check.reference = "the surface integral by Monte Carlo";
    }
    if (layout.single_terms > 0) {
        check.effect += check.effect.empty() ? "single" : "+single";
        check.reference +=
            std::string(check.reference.empty() ? "" : ", and ") + "rays to twice as many depths";
    }
    const std::size_t step = (points.size() + kMostCheckedInMedia - 1) / kMostCheckedInMedia;
    for_each_block_in_order(
        points.size(), 1, context,
        [&](Range range) {
            const CheckPoint& point = points[range.begin];
            CheckedPoint found{point.primitive, {}, 0};
            if (point.material == medium.material && range.begin % step == 0) {
                append_pairs(relight_point(asset, point, &layout, lights),
                             eval_truth(medium.truth, medium.scene, medium.rays, point.body,
                                        medium.seed, point.key, found.rays),
                             found.pairs);
            }
            return found;
        },
        [&](Range, const CheckedPoint& found) { append_point(found, check); });
    return check;
}

}  // namespace opaline::bake
