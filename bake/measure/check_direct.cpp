#include "bake/measure/check_direct.h"

#include <array>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/stored_luminance.h"
#include "bake/measure/truth.h"

namespace opaline::bake {

EffectCheck check_direct(const RayScene& rays, std::span<const Receiver> receivers,
                         const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                         std::span<const TestLight> lights, const Context& context) {
    constexpr std::array<float, 1> kDiffuse{1.0f};
    EffectCheck check{
        "direct", "rays to the suns, and to all else four a texel of 6 x 64 x 64", {}, 0};
    const DirectTruth truth = make_direct_truth(lights);
    struct Found {
        std::vector<CheckedPair> pairs;
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        drawn.size(), 1, context,
        [&](Range range) {
            Found found;
            const std::uint32_t v = drawn[range.begin];
            const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, v);
            if (primitive.shading == formats::Shading::diffuse) {
                append_pairs(relight_rows(asset.transport, primitive.rows(),
                                          v - primitive.first_vertex, kDiffuse, lights),
                             eval_truth(truth, rays, receivers[v], lights, found.rays),
                             found.pairs);
            }
            return found;
        },
        [&](Range, const Found& found) {
            check.pairs.insert(check.pairs.end(), found.pairs.begin(), found.pairs.end());
            check.rays += found.rays;
        });
    return check;
}

}  // namespace opaline::bake
