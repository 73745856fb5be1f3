#include "bake/pipeline/volume_stages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bake/accuracy/error_warnings.h"
#include "bake/accuracy/volumes/volume_error.h"
#include "bake/base/interrupted.h"
#include "bake/volumes/bake_volumes.h"
#include "bake/volumes/dim_surfaces.h"
#include "bake/volumes/volume_knobs.h"
#include "bake/volumes/volume_parts.h"
#include "bake/volumes/volume_work.h"

namespace opaline::bake {
namespace {

// Volumes of one quality, and how far they err.
struct BakedVolumes {
    Knobs knobs;
    VolumePlan plan;
    VolumeParts parts;  // of the plan's layouts
    formats::Volumes volumes;
    VolumeFindings findings;
    std::optional<VolumeErrorReport> error;  // nothing: they scatter no light

    double rms() const { return error ? error->rms_relative : 0; }
    VolumeCheckOptions check_effort(const formats::Scene& scene) const {
        return volume_check_effort(count_volume_work(parts.scene_or(scene), parts.layouts, knobs),
                                   parts.layouts, knobs);
    }
};

formats::Result<BakedVolumes> bake_and_check(const VolumeStages& inputs, const Knobs& knobs,
                                             const Context& context, BakeResult& result) {
    BakedVolumes baked{knobs, plan_volumes(inputs.scene, knobs), {}, {}, {}, {}};
    baked.parts = part_volumes(inputs.scene, baked.plan.layouts, knobs);
    const formats::AssetView surfaces = result.asset.view();
    const ShownSurfaces shown{inputs.scene, inputs.layouts, inputs.receivers, surfaces};
    auto volumes = bake_volumes(
        {baked.parts.scene_or(inputs.scene), inputs.rays, baked.parts.layouts, knobs, &shown},
        context, result.stages, &baked.findings);
    if (!volumes) return std::move(volumes).error();
    for (const MethodMeasure& measure : baked.findings.methods) {
        tell_method(measure, method_budget(knobs), baked.plan.entries);
    }
    if (context.cancelled()) return interrupted();
    baked.volumes = std::move(*volumes);
    if (std::ranges::none_of(baked.plan.layouts, &VolumeLayout::has_nodes)) return baked;
    formats::AssetView view = result.asset.view();
    view.volumes = baked.volumes.view();
    auto error =
        run_stage(result.stages, "self-check of volumes", "self-check", [&](std::uint64_t& traced) {
            auto found =
                check_volumes(inputs.scene, view, baked.check_effort(inputs.scene), context);
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
formats::Result<BakedVolumes> bake_for_target(const VolumeStages& inputs, const Context& context,
                                              BakeResult& result) {
    constexpr double kLeastGain = 0.9;
    std::optional<BakedVolumes> best;
    for (const Quality quality :
         {Quality::draft, Quality::preview, Quality::production, Quality::reference}) {
        auto tried = bake_and_check(
            inputs, with_volume_quality(inputs.effects, result.knobs, quality), context, result);
        if (!tried) return std::move(tried).error();
        result.volume_trials.push_back({quality, tried->rms()});
        if (best && tried->rms() > kLeastGain * best->rms()) break;
        best = std::move(*tried);
        if (best->rms() <= result.knobs.error_target) break;
    }
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
formats::Status measure_glow(const VolumeStages& inputs, const VolumeCheckOptions& effort,
                             const Context& context, BakeResult& result) {
    if (result.glowing_volumes.empty()) return formats::ok_status();
    auto error = run_stage(
        result.stages, "self-check of light of volumes", "self-check", [&](std::uint64_t& traced) {
            auto found = check_glow(inputs.scene, result.asset.view(), effort, context);
            traced += found ? found->events : 0;
            return found;
        });
    if (!error) return std::move(error).error();
    result.error.add_part("light of volumes", error->rays_checked, error->rms_relative);
    return formats::ok_status();
}

// What was chosen, so that the same options give the same bake again.
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

// The self-check saw the rows before volumes dimmed them; encoding them again errs by itself, and
// both are independent.
void add_encoding_error(const DimmedError& dimmed, BakeResult& result) {
    const auto widen = [&](MeasuredError& error) {
        for (double* const e : {&error.rms_relative, &error.ci95[0], &error.ci95[1]}) {
            *e = std::hypot(*e, dimmed.rms_relative);
        }
    };
    widen(result.error);
    widen(result.error.at_receivers);
    widen(result.error.between);
    result.error.by_effect.push_back({"shadows of volumes", dimmed.rms_relative});
    for (std::size_t i = 0; i < result.receiver_errors.size(); ++i) {
        result.receiver_errors[i] = std::hypot(result.receiver_errors[i], dimmed.receivers[i]);
    }
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
    for (formats::GlowRecord& record : result.asset.volumes.glow.record) {
        record.emitter = number[record.emitter];
    }
}

formats::Status add_volumes(const VolumeStages& inputs, const Context& context,
                            BakeResult& result) {
    const bool has_target = result.knobs.error_target > 0;
    auto baked = has_target ? bake_for_target(inputs, context, result)
                            : bake_and_check(inputs, result.knobs, context, result);
    if (!baked) return std::move(baked).error();
    if (has_target) {
        keep_knobs(inputs.effects, *baked, result.knobs);
    }
    for (const VolumeLayout& layout : baked->plan.layouts) {
        if (layout.glows) {
            result.glowing_volumes.push_back(inputs.scene.volumes[layout.volume].emitter);
        }
    }
    warn_of_noise(inputs.scene, baked->findings.noise, result.warnings);
    const VolumeParts& parts = baked->parts;
    result.asset.volumes = std::move(baked->volumes);
    if (auto status = measure_glow(inputs, baked->check_effort(inputs.scene), context, result);
        !status) {
        return status;
    }
    replace_entries(Subject::Kind::volume, baked->plan.entries, result.plan);
    result.volume_error = std::move(baked->error);
    if (result.asset.position.empty()) return formats::ok_status();
    const auto dimmed = run_stage(result.stages, "shadows of volumes", [&](std::uint64_t& rays) {
        if (std::ranges::none_of(parts.layouts, &VolumeLayout::lights_surfaces)) {
            return dim_surfaces(inputs.scene, result.knobs, nullptr, context, result.asset, rays);
        }
        const SentLight light =
            make_sent_light(parts.scene_or(inputs.scene), inputs.rays, parts.layouts,
                            result.asset.volumes.view(), result.knobs);
        const VertexLight sent{light, inputs.receivers};
        return dim_surfaces(inputs.scene, result.knobs, &sent, context, result.asset, rays);
    });
    if (!dimmed) {
        return dimmed.error();
    }
    if (context.cancelled()) return interrupted();
    add_encoding_error(*dimmed, result);
    return formats::ok_status();
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
