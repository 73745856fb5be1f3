#include "bake/prepare_media.h"

#include <algorithm>
#include <cmath>
#include <optional>
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
                const std::uint32_t kept = std::min(knobs.coefficients, 4096u);
                MultipleStage stage = prepare_multiple(
                    scene, pilot.rays_of(m), m, pilot.profiles.at(m),
                    {knobs.cubemap_size, knobs.samples, knobs.exact_samples, knobs.samples_per_path,
                     kept, knobs.seed, !knobs.exact_rays, layouts[m].bands()},
                    context);
                traced = stage.transport.rays;
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

MediaStages choose_knobs(const PilotScene& pilot, std::vector<TestLight>& lights,
                         const Context& context, BakeResult& result) {
    Knobs& knobs = result.knobs;
    result.accuracy = AccuracyReport{knobs.error_target, 0, 0, false, {}};
    const std::vector<PilotReceiver> receivers =
        run_stage(result, "pilot truth",
                  [&](std::uint64_t&) { return find_pilot_truth(pilot, knobs, lights, context); });
    while (!context.cancelled()) {
        project_test_lights(lights, knobs.cubemap_size);
        PilotChoice choice;
        choice.knobs = knobs;
        // Samples of media are not worth taking where the opaque receivers need more texels.
        const OpaquePairs opaque = run_stage(result, "pilot", [&](std::uint64_t&) {
            return measure_opaque(pilot, receivers, knobs, lights, context);
        });
        const double floor = find_direct_floor(opaque, receivers);
        MediaStages media;
        bool has_samples = false;
        if (floor <= knobs.error_target || !refine_knobs(choice, false)) {
            media = prepare_media(pilot, knobs, context, result);
            for (const auto& [m, stages] : media) {
                has_samples = has_samples || stages.multiple.has_value();
            }
            choice = run_stage(result, "pilot", [&](std::uint64_t&) {
                return choose_row_knobs(pilot, receivers, opaque, knobs, media, lights, context);
            });
        }
        for (const PilotTrial& trial : choice.trials) {
            result.accuracy->trials.push_back({knobs.cubemap_size, knobs.samples_per_path, trial});
        }
        const std::optional<Knobs> finer =
            choice.met ? std::nullopt : refine_knobs(choice, has_samples);
        if (!finer) {
            knobs = choice.knobs;
            result.accuracy->predicted = choice.error;
            result.accuracy->likely = choice.likely;
            result.accuracy->met = choice.met;
            return media;
        }
        knobs = *finer;
    }
    return {};
}

void warn_of_missed_target(const BakeResult& result, std::vector<formats::Diagnostic>& warnings) {
    const AccuracyReport& accuracy = *result.accuracy;
    const auto percent = [](double error) {
        const std::string text = std::to_string(1e-3 * std::round(1e5 * error));
        return text.substr(0, text.find('.') + 3) + " %";
    };
    const Knobs::Fixed& fixed = result.knobs.fixed;
    std::string given;  // by the user: the pilot could not change them
    for (const auto& [is_given, option] : {std::pair{fixed.cubemap, "--cubemap"},
                                           {fixed.coefficients, "--coefficients"},
                                           {fixed.tolerance, "--epsilon"},
                                           {fixed.depth_samples, "--depth-samples"}}) {
        given += is_given ? (given.empty() ? "" : ", ") + std::string(option) : "";
    }
    if (!accuracy.met) {
        warnings.push_back(formats::make_warning(
            "", "--error",
            percent(accuracy.target) + " is out of reach: the finest knobs tried leave " +
                percent(accuracy.likely) + ", and were taken",
            given.empty() ? "ask for more, or give the scene more vertices where shadows end"
                          : "leave " + given + " out"));
    } else if (result.error.rms_relative > accuracy.target) {
        warnings.push_back(
            formats::make_warning("", "--error",
                                  "the self-check measured " + percent(result.error.rms_relative) +
                                      ", more than the " + percent(accuracy.target) + " asked for",
                                  "ask for a little less"));
    }
}

}  // namespace opaline::bake
