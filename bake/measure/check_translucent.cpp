#include "bake/measure/check_translucent.h"

#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/stored_luminance.h"
#include "bake/measure/truth.h"

namespace opaline::bake {

EffectCheck check_translucent(const TranslucentRecipe& recipe, const formats::Scene& scene,
                              const RayScene& rays, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const BodyPoint> points,
                              const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                              std::span<const TestLight> lights, std::uint64_t seed,
                              const Context& context) {
    EffectCheck check;
    if (recipe.profile != nullptr) {
        check.effect = "multiple";
        check.reference = "the surface integral by Monte Carlo";
    }
    const bool once = recipe.layout.single_terms > 0;
    if (once) {
        check.effect += check.effect.empty() ? "single" : "+single";
        check.reference +=
            std::string(check.reference.empty() ? "" : ", and ") + "rays to twice as many depths";
    }
    const TranslucentTruth truth = make_translucent_truth(scene, material, recipe.profile,
                                                          once ? 2 * depth_samples : 0, lights);
    // Enough to tell a tenth; each costs as much as the rows of some dozens.
    constexpr std::size_t kMostChecked = 256;
    const std::size_t step = (drawn.size() + kMostChecked - 1) / kMostChecked;
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
            if (primitive.material == material && range.begin % step == 0) {
                append_pairs(relight_rows(asset.transport, primitive.rows(),
                                          (v - primitive.first_vertex) * primitive.terms,
                                          view_of_rows(recipe.layout, points[v].normal), lights),
                             eval_truth(truth, scene, rays, points[v], seed, v, found.rays),
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
