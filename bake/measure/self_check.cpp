#include "bake/measure/self_check.h"

#include <string>
#include <utility>
#include <vector>

#include "bake/measure/check_direct.h"
#include "bake/measure/check_point.h"
#include "bake/measure/check_translucent.h"
#include "bake/measure/surface_probes.h"
#include "bake/plan/check_counts.h"

namespace opaline::bake {
namespace {

// A medium that neither scatters nor lets through what it is lit by is black: nothing to be wrong.
bool is_black(const MediumStages& stages) {
    return !stages.multiple && !stages.single && !stages.local;
}

// Primitives that something is simulated for.
std::vector<std::uint32_t> find_lit_primitives(const SelfCheck& baked) {
    std::vector<std::uint32_t> lit;
    for (std::uint32_t p = 0; p < baked.scene.primitives.size(); ++p) {
        const std::uint32_t material = baked.scene.primitives[p].material;
        const auto medium = baked.media.find(material);
        if (medium == baked.media.end() ? baked.layouts[material].direct
                                        : !is_black(medium->second)) {
            lit.push_back(p);
        }
    }
    return lit;
}

}  // namespace

ErrorReport check_file(const SelfCheck& baked, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced) {
    const std::uint64_t seed = baked.knobs.seed;
    const std::vector<std::uint32_t> drawn = draw_evenly(
        baked.receivers.size(), count_checked(baked.receivers.size(), baked.knobs.cubemap_size),
        RandomStage::held_back_receivers, seed);
    const std::vector<CheckPoint> receivers =
        make_check_points(asset, baked.receivers, baked.points, drawn);
    const auto after_all = static_cast<std::uint32_t>(baked.receivers.size());
    const std::vector<CheckPoint> between =
        draw_surface_probes(baked.scene, baked.rays, find_lit_primitives(baked),
                            {drawn.size(), seed, after_all}, context);
    std::vector<EffectCheck> checks;
    const auto add = [&](EffectCheck check, bool is_between) {
        check.between = is_between;
        traced += check.rays;
        checks.push_back(std::move(check));
    };
    for (const auto* points : {&receivers, &between}) {
        add(check_direct(baked.rays, asset, *points, baked.lights, context), points == &between);
    }
    for (const auto& [material, stages] : baked.media) {
        if (is_black(stages)) {
            continue;
        }
        MediumCheck medium = make_medium_check(baked.scene, baked.rays, stages.recipe, material,
                                               baked.knobs.depth_samples, baked.lights);
        medium.seed = seed;
        for (const auto* points : {&receivers, &between}) {
            add(check_translucent(medium, asset, *points, baked.lights, context),
                points == &between);
        }
    }
    std::vector<std::string> names;
    for (const TestLight& light : baked.lights) {
        names.push_back(light.name);
    }
    return summarise_checks(checks, names, seed);
}

}  // namespace opaline::bake
