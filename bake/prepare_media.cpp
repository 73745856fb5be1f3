#include "bake/prepare_media.h"

#include <string>
#include <utility>

#include "bake/run_stage.h"

namespace opaline::bake {

MediaProfiles make_profiles(const formats::Scene& scene, std::span<const RowLayout> layouts,
                            std::uint64_t seed, const Context& context) {
    MediaProfiles profiles;
    for (std::uint32_t m = 0; m < layouts.size(); ++m) {
        if (layouts[m].translucent && layouts[m].multiple) {
            profiles.emplace(m, make_medium_profile(*scene.materials[m].medium, seed, context));
        }
    }
    return profiles;
}

MediaStages prepare_media(const PilotScene& pilot, const Knobs& knobs, const Context& context,
                          BakeResult& result) {
    const formats::Scene& scene = pilot.scene;
    const std::span<const RowLayout> layouts = pilot.layouts;
    MediaStages media;
    for (std::uint32_t m = 0; m < layouts.size(); ++m) {
        if (!layouts[m].translucent) {
            continue;
        }
        MediumStages& stages = media[m];
        stages.recipe.layout = layouts[m];
        if (layouts[m].multiple) {
            stages.recipe.profile = &pilot.profiles.at(m);
        }
        if (layouts[m].local) {
            stages.local = make_local_stage(*scene.materials[m].medium, stages.recipe.profile,
                                            layouts[m].single_terms > 0, knobs.cubemap_size,
                                            layouts[m].bands());
            stages.recipe.local = &*stages.local;
        } else if (layouts[m].multiple) {
            const std::string name = "samples of material '" + scene.materials[m].name + "'";
            stages.multiple = run_stage(result, name, [&](std::uint64_t& traced) {
                MultipleStage stage = prepare_multiple(
                    scene, pilot.rays_of(m), m, pilot.profiles.at(m),
                    {knobs.cubemap_size, knobs.samples, knobs.exact_samples, knobs.samples_per_path,
                     sample_coefficients(knobs), knobs.seed, !knobs.exact_rays, layouts[m].bands()},
                    context);
                traced = stage.rays;
                return stage;
            });
            stages.recipe.multiple = &*stages.multiple;
        }
    }
    return media;
}

void finish_media(const PilotScene& pilot, const Knobs& knobs, const Context& context,
                  BakeResult& result, MediaStages& media) {
    for (auto& [m, stages] : media) {
        TranslucentRecipe& recipe = stages.recipe;
        if (recipe.layout.single_terms > 0 && !recipe.layout.local) {
            const std::string name =
                "light maps of material '" + pilot.scene.materials[m].name + "'";
            const std::uint32_t material = m;
            const SingleOptions options{knobs.single_cubemap, knobs.depth_samples,
                                        recipe.layout.single_terms, knobs.exact_rays,
                                        recipe.layout.bands()};
            stages.single = run_stage(result, name, [&](std::uint64_t&) {
                return prepare_single(pilot.scene, pilot.rays, material, options, context);
            });
            recipe.single = &*stages.single;
        }
        recipe.gather = {knobs.tolerance};
        recipe.selector = make_selector(knobs.cubemap_size, knobs.coefficients);
        recipe.code_bits = knobs.code_bits;
    }
}

}  // namespace opaline::bake
