#include "bake/measure/check_direct.h"

#include "bake/base/ordered_parallel.h"
#include "bake/measure/stored_luminance.h"
#include "bake/measure/truth.h"

namespace opaline::bake {

EffectCheck check_direct(const RayScene& rays, const formats::AssetView& asset,
                         std::span<const CheckPoint> points, std::span<const TestLight> lights,
                         const Context& context) {
    EffectCheck check;
    check.effect = "direct";
    check.reference = "rays to the suns, and to all else four a texel of 6 x 64 x 64";
    const DirectTruth truth = make_direct_truth(lights);
    for_each_block_in_order(
        points.size(), 1, context,
        [&](Range range) {
            const CheckPoint& point = points[range.begin];
            CheckedPoint found{point.primitive, {}, 0};
            if (asset.primitives[point.primitive].shading == formats::Shading::diffuse) {
                append_pairs(relight_point(asset, point, nullptr, lights),
                             eval_truth(truth, rays, point.receiver, lights, found.rays),
                             found.pairs);
            }
            return found;
        },
        [&](Range, const CheckedPoint& found) { append_point(found, check); });
    return check;
}

}  // namespace opaline::bake
