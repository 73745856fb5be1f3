#include "bake/pipeline/volume_stages.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/base/interrupted.h"
#include "bake/check/error_warnings.h"
#include "bake/check/volumes/volume_error.h"
#include "bake/effects/volumes/bake_glow.h"
#include "bake/effects/volumes/lamp_walks.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_work.h"
#include "bake/trace/density/density_space.h"

namespace opaline::bake {
namespace {

double rms_of(const BakedVolumes& baked) {
    return baked.error ? baked.error->rms_relative : 0;
}

VolumeCheckOptions check_effort(const BakedVolumes& baked, const formats::Scene& scene) {
    const VolumeParts& parts = baked.parts;
    return volume_check_effort(count_volume_work(parts.scene_or(scene), parts.layouts, baked.knobs),
                               parts.layouts, baked.knobs);
}

// A file of volumes alone, as their checks see it.
formats::AssetView view_of(const BakedVolumes& baked) {
    formats::AssetView view;
    view.cubemap_size = baked.knobs.cubemap_size;
    view.volumes = baked.volumes.view();
    return view;
}

formats::Result<BakedVolumes> bake_and_check(const VolumeStages& inputs, const Knobs& knobs,
                                             const Context& context, StageLog& log) {
    BakedVolumes baked;
    baked.knobs = knobs;
    baked.plan = plan_volumes(inputs.scene, knobs);
    baked.parts = part_volumes(inputs.scene, baked.plan.layouts, knobs);
    auto volumes = bake_volumes({baked.parts.scene_or(inputs.scene), inputs.rays,
                                 baked.parts.layouts, knobs, inputs.surfaces},
                                context, log, &baked.findings);
    if (!volumes) return std::move(volumes).error();
    for (const MethodMeasure& measure : baked.findings.methods) {
        tell_method(measure, method_budget(knobs), baked.plan.entries);
    }
    if (context.cancelled()) return interrupted();
    baked.volumes = std::move(*volumes);
    if (std::ranges::none_of(baked.plan.layouts, &VolumeLayout::has_nodes)) return baked;
    auto error = run_stage(log, "self-check of volumes", "self-check", [&](std::uint64_t& traced) {
        auto found =
            check_volumes(inputs.scene, view_of(baked), check_effort(baked, inputs.scene), context);
        traced += found ? found->events : 0;
        return found;
    });
    if (!error) return std::move(error).error();
    if (error->rays_checked > 0) {
        baked.error = std::move(*error);
    }
    return baked;
}

// Quality after quality, until the error is low enough or hardly falls.
formats::Result<BakedVolumes> bake_for_target(const VolumeStages& inputs, const Knobs& knobs,
                                              const Context& context, StageLog& log) {
    constexpr double kLeastGain = 0.9;
    std::optional<BakedVolumes> best;
    std::vector<VolumeTrial> trials;
    for (const Quality quality :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        auto tried = bake_and_check(inputs, with_volume_quality(inputs.effects, knobs, quality),
                                    context, log);
        if (!tried) return std::move(tried).error();
        trials.push_back({quality, rms_of(*tried)});
        if (best && rms_of(*tried) > kLeastGain * rms_of(*best)) break;
        best = std::move(*tried);
        if (rms_of(*best) <= knobs.error_target) break;
    }
    best->trials = std::move(trials);
    return std::move(*best);
}

// Noise from point to point that eyes find at once.
void warn_of_noise(const formats::Scene& scene, std::span<const RowNoise> noises,
                   std::vector<formats::Diagnostic>& warnings) {
    constexpr double kVisible = 0.1;
    for (const RowNoise& own : noises) {
        if (own.noise <= kVisible) continue;
        warnings.push_back(formats::make_warning(
            "", "volume '" + scene.volumes[own.volume].name + "'",
            "light that was scattered more than once has noise of " + error_percent(own.noise) +
                " from point to point: visible as blotches",
            "give more --volume-walks (four times as many halve it), or a finer --quality"));
    }
}

// How far the light of volumes errs, where there is any.
formats::Status measure_glow(const VolumeStages& inputs, const Context& context, StageLog& log,
                             BakedVolumes& baked) {
    if (count_glowing(baked.plan.layouts) == 0) return formats::ok_status();
    auto error =
        run_stage(log, "self-check of light of volumes", "self-check", [&](std::uint64_t& traced) {
            auto found = check_glow(inputs.scene, view_of(baked), check_effort(baked, inputs.scene),
                                    context);
            traced += found ? found->events : 0;
            return found;
        });
    if (!error) return std::move(error).error();
    baked.glow = *error;
    return formats::ok_status();
}

// What volumes scatter of the light of lamps, and how far it errs.
formats::Status add_light_of_lamps(const VolumeStages& inputs, const Context& context,
                                   StageLog& log, BakedVolumes& baked) {
    const auto& layouts = baked.parts.layouts;
    const bool are_lit =
        std::ranges::any_of(layouts, [](const auto& own) { return own.glow_terms > 0; }) &&
        std::ranges::any_of(inputs.lamps,
                            [](const Lamp& lamp) { return lamp.volume == formats::kNone; });
    if (!are_lit) return formats::ok_status();
    const VolumeJob job{baked.parts.scene_or(inputs.scene), inputs.rays, layouts, baked.knobs};
    formats::Glow& glow = baked.volumes.glow;
    glow = run_stage(log, kLampsInVolumes, "emitters: rows", [&](std::uint64_t& traced) {
        return join_glow(glow, bake_lamp_glow(job, place_nodes(job), {inputs.scene, inputs.lamps},
                                              context, traced));
    });
    if (context.cancelled()) return interrupted();
    const auto first = static_cast<std::uint32_t>(count_glowing(layouts));
    auto error = run_stage(
        log, "self-check of emitters in volumes", "self-check", [&](std::uint64_t& traced) {
            VolumeCheckOptions effort = check_effort(baked, inputs.scene);
            effort.max_events *= kEventsOfLamps;
            auto found = check_lamps(inputs.scene, view_of(baked), first, effort, context);
            traced += found ? found->events : 0;
            return found;
        });
    if (!error) return std::move(error).error();
    baked.lamps = *error;
    return formats::ok_status();
}

}  // namespace

VolumeCheckOptions volume_check_effort(std::span<const VolumeWork> works,
                                       std::span<const VolumeLayout> layouts, const Knobs& knobs) {
    VolumeCheckOptions options;
    options.seed = knobs.seed;
    options.sees_surfaces = sees_surfaces(layouts);
    if (knobs.check_model) {
        options.probes = 128;
        options.noise_share = 0.25;
        options.max_events = 20000000;
        return options;
    }
    constexpr double kShare = 0.08, kLeast = 2e5, kMost = 2e7;
    const double bake = count_in_scatterings(works);
    options.max_events = static_cast<std::uint64_t>(std::clamp(kShare * bake, kLeast, kMost));
    return options;
}

Knobs with_volume_quality(const EffectTable& effects, Knobs knobs, Quality quality) {
    knobs.quality = quality;
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (effect.kind == Subject::Kind::volume && !knobs.is_given(*knob)) {
                knobs.set(*knob, knob->preset[static_cast<std::size_t>(quality)]);
            }
        }
    }
    return knobs;
}

void number_glow(std::span<const Lamp> lamps, BakeResult& result) {
    formats::Emitters& emitters = result.asset.emitters;
    std::vector<std::uint32_t> number;
    for (std::uint32_t glow = 0; glow < result.glowing_volumes.size(); ++glow) {
        const auto lit = std::ranges::find(lamps, glow, &Lamp::glow);
        if (lit != lamps.end()) {
            number.push_back(static_cast<std::uint32_t>(lit - lamps.begin()));
            continue;
        }
        number.push_back(emitters.view().size());
        std::vector<std::string> taken;
        for (std::uint32_t e = 0; e < emitters.view().size(); ++e) {
            taken.emplace_back(emitters.view().name(e));
        }
        append_emitter(emitters, free_emitter_name(result.glowing_volumes[glow], taken));
    }
    for (std::uint32_t e = 0; e < lamps.size(); ++e) {
        number.push_back(e);
    }
    formats::Glow& glow = result.asset.volumes.glow;
    for (formats::GlowRecord& record : glow.record) {
        record.emitter = number[record.emitter];
    }
    glow = join_glow(glow, {});
}

formats::Result<BakedVolumes> bake_and_measure(const VolumeStages& inputs, const Knobs& knobs,
                                               const Context& context, StageLog& log) {
    auto baked = knobs.error_target > 0 ? bake_for_target(inputs, knobs, context, log)
                                        : bake_and_check(inputs, knobs, context, log);
    if (!baked) return baked;
    if (auto status = measure_glow(inputs, context, log, *baked); !status) {
        return std::move(status).error();
    }
    if (auto status = add_light_of_lamps(inputs, context, log, *baked); !status) {
        return std::move(status).error();
    }
    return baked;
}

void keep_knobs(const EffectTable& effects, const BakedVolumes& baked, Knobs& knobs) {
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            if (effect.kind == Subject::Kind::volume) {
                knobs.set(*knob, baked.knobs[*knob]);
            }
        }
    }
    const auto& layouts = baked.parts.layouts;
    if (!baked.parts.scene && !layouts.empty() &&
        std::ranges::all_of(layouts, [&](const VolumeLayout& layout) {
            return layout.spacing == layouts.front().spacing;
        })) {
        knobs.set(kVolumeSpacing, layouts.front().spacing);
    }
}

bool colours_surfaces(const formats::Scene& scene, std::span<const VolumeLayout> layouts) {
    if (layouts.empty()) return false;
    const DensitySpace space = make_density_space(scene, layouts);
    return !space.is_grey ||
           (!space.light_grey && std::ranges::any_of(layouts, &VolumeLayout::lights_surfaces));
}

std::optional<SentLight> find_sent_light(const VolumeStages& inputs, const BakedVolumes& baked,
                                         const Knobs& knobs) {
    const VolumeParts& parts = baked.parts;
    if (std::ranges::none_of(parts.layouts, &VolumeLayout::lights_surfaces)) return std::nullopt;
    return make_sent_light(parts.scene_or(inputs.scene), inputs.rays, parts.layouts,
                           baked.volumes.view(), knobs);
}

void add_volumes(const formats::Scene& scene, BakedVolumes&& baked, BakeResult& result) {
    for (const VolumeLayout& layout : baked.plan.layouts) {
        if (layout.glows) {
            result.glowing_volumes.push_back(scene.volumes[layout.volume].emitter);
        }
    }
    warn_of_noise(scene, baked.findings.noise, result.warnings);
    if (baked.glow) {
        result.error.add_part("light of volumes", baked.glow->rays_checked,
                              baked.glow->rms_relative);
    }
    if (baked.lamps) {
        result.error.add_part("emitters in volumes", baked.lamps->rays_checked,
                              baked.lamps->rms_relative);
    }
    replace_entries(Subject::Kind::volume, baked.plan.entries, result.plan);
    result.asset.volumes = std::move(baked.volumes);
    result.volume_error = std::move(baked.error);
    result.volume_trials = std::move(baked.trials);
    warn_of_volumes(result.knobs, result.volume_error, result.warnings);
}

void warn_of_volumes(const Knobs& knobs, const std::optional<VolumeErrorReport>& error,
                     std::vector<formats::Diagnostic>& warnings) {
    if (!error || error->by_light.empty()) return;
    const bool asked = knobs.error_target > 0;
    const double limit = asked ? knobs.error_target : acceptable_error(knobs.quality);
    if ((asked ? error->rms_relative : error->ci95[0]) <= limit) return;
    const auto worst =
        std::ranges::max_element(error->by_light, {}, &VolumeErrorReport::Part::rms_relative);
    warnings.push_back(formats::make_warning(
        "", asked ? "--error" : "self-check",
        "volumes err by " + error_percent(error->rms_relative) +
            " (95 %: " + error_percent(error->ci95[0]) + " to " + error_percent(error->ci95[1]) +
            "), more than the " + error_percent(limit) +
            (asked ? " asked for; finer settings help little" : " that pass unnoticed") +
            "; most under light of the class '" + worst->name + "'",
        asked ? "accept the error, or give --volume-walks, --volume-spacing and "
                "--volume-coefficients"
              : "choose a finer --quality, or more --volume-walks and a smaller "
                "--volume-spacing"));
}

}  // namespace opaline::bake
