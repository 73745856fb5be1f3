#include "bake/pipeline/emitter_stages.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "bake/check/check_lit_media.h"
#include "bake/check/error_warnings.h"
#include "bake/effects/emitters/bake_emitters.h"
#include "bake/effects/emitters/emitter_knobs.h"
#include "bake/effects/emitters/lit_media.h"
#include "bake/effects/rows/medium_rows.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_work.h"
#include "bake/pipeline/shared_light.h"
#include "bake/plan/bake_plan.h"
#include "bake/plan/stage_work.h"

namespace opaline::bake {
namespace {

// Flights of a particle, mostly: it ends where it meets a surface that is no metal and lets nothing
// through.
constexpr double kFlights = 1.5;
// Rays that meet surfaces everywhere, over rays beside each other.
constexpr double kIncoherent = 4;

// Steps of a ray through volumes that glow or scatter light of lamps, in times of steps of a depth:
// half across, and each with the light of eight nodes.
double glow_steps(const formats::Scene& scene) {
    constexpr double kShare = 0.5, kOfNodes = 12;
    double voxels = 0;
    for (const formats::Volume& volume : scene.volumes) {
        voxels = std::max({voxels, static_cast<double>(volume.emission.value.size()),
                           static_cast<double>(volume.density.value.size())});
    }
    return kShare * kOfNodes * std::cbrt(voxels);
}

// Media that no effect of the plan lights with light of lamps.
bool has_dark_media(const BakeInputs& bake, std::span<const PlanEntry> plan,
                    std::span<const SubjectState> subjects) {
    return std::ranges::any_of(subjects, [&](const SubjectState& subject) {
        const auto decisions = entries_of(plan, subject.material);
        const bool is_clear =
            bake.scene.materials[subject.material].medium->sigma_s == formats::Rgb{};
        return subject.layout.translucent && subject.layout.has_rows() &&
               !takes_other_light(bake.effects, decisions, subject.layout) &&
               !(is_clear && lets_light_cross(bake.effects, decisions, subject.layout));
    });
}

void warn_of_unlit(const formats::Scene& scene, bool has_dark,
                   std::vector<formats::Diagnostic>& warnings) {
    std::string unlit = has_dark ? "media whose multiple scattering is left out" : "";
    if (!scene.layers.empty()) unlit += unlit.empty() ? "cloud layers" : ", cloud layers";
    if (unlit.empty()) return;
    warnings.push_back(
        formats::make_warning("", std::string(kEmitters),
                              "their light does not reach " + unlit + ", which stay dark under it",
                              has_dark ? "let --effects have light scattered many times"
                                       : "nothing needs to be done where that is not seen"));
}

void warn_of_immersed(std::span<const std::string> immersed,
                      std::vector<formats::Diagnostic>& warnings) {
    for (const std::string& name : immersed) {
        warnings.push_back(formats::make_warning(
            "", "emitter '" + name + "'",
            "it lies inside of a translucent medium: its light does not leave the body",
            "put it into a hollow of the body, whose surface faces it"));
    }
}

formats::Status check_media(const BakeInputs& bake, std::span<const Lamp> lamps,
                            const Context& context, BakeResult& result) {
    if (std::ranges::none_of(result.asset.primitives, [](const formats::PrimitiveRecord& record) {
            return record.shading == formats::Shading::translucent;
        })) {
        return formats::ok_status();
    }
    auto checked =
        run_stage(result.stages, "self-check of media lit by emitters", [&](std::uint64_t&) {
            return check_lit_media(bake.scene, result.asset.view(), lamps, result.knobs.seed,
                                   context);
        });
    if (!checked) return std::move(checked).error();
    result.error.add_part("emitters in media", checked->receivers_checked, checked->rms_relative);
    return formats::ok_status();
}

// What media make of the light of some lamps; nothing where there are none.
std::optional<Work> work_of_media(const CostedBake& bake, std::size_t lamps) {
    const CostRequest& request = bake.request;
    std::optional<Work> all;
    for (const CostedSubject& subject : bake.subjects) {
        CostedSubject lit = subject;
        lit.layout = lit_layout(subject.layout);
        const double receivers = request.facts.material[subject.material].receivers;
        Knobs knobs = request.knobs;
        knobs.cubemap_size = lamp_basis(lamps);
        if (lets_light_cross(request.effects, subject.decisions, subject.layout)) {
            if (!all) all.emplace();
            *all += work_of_points(bake, lit, knobs, receivers, [&](std::size_t e) {
                return request.effects.effects[e].look_through != nullptr;
            });
        }
        if (!takes_other_light(request.effects, subject.decisions, subject.layout)) continue;
        if (!all) all.emplace();
        *all += work_of_points(bake, lit, knobs, receivers, [&](std::size_t e) {
            return request.effects.effects[e].adds_other_light;
        });
    }
    return all;
}

// Points of surfaces that lamps light. Where no effect follows the sky's light between them, the
// stage that finds them is billed, too.
double bill_points(const CostedBake& bake, PlanEntry* payer, Bill& bill) {
    const CostRequest& request = bake.request;
    const auto& effects = request.effects.effects;
    double points = 0;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        if (effects[e].light_work == nullptr) continue;
        const LightWork light = effects[e].light_work(bake.input);
        points = light.points;
        if (std::ranges::any_of(bake.subjects, [e](const CostedSubject& subject) -> bool {
                return subject.acts[e];
            })) {
            continue;
        }
        bill.open("surfaces that emitters light");
        bill.add(light.work, payer);
        const Knobs coarse = coarse_knobs(request.effects, request.knobs, light.cubemap_size);
        for (const CostedSubject& subject : bake.subjects) {
            if (subject.layout.translucent) {
                bill.add(work_of_points(bake, subject, coarse,
                                        points / static_cast<double>(bake.subjects.size()),
                                        [](std::size_t) { return true; }),
                         payer);
            }
        }
    }
    return points;
}

}  // namespace

formats::Status add_lamp_rows(const BakeInputs& bake, std::span<const Lamp> lamps,
                              std::shared_ptr<const BounceLight> surfaces, const Context& context,
                              std::vector<SubjectState>& subjects, BakeResult& result) {
    const std::vector<RowLayout> layouts = layouts_of(bake.scene, subjects);
    const FinishedMedia finished{bake, result.plan, result.knobs, subjects};
    LitMedia media;
    if (std::ranges::any_of(layouts, &RowLayout::translucent)) {
        media = {&finished, layouts};
    }
    if (!surfaces) {
        surfaces = find_light_for_lamps(
            {bake, result.knobs, context, layouts, subjects, {}, result.stages});
    }
    auto baked = bake_emitters(
        {bake.scene, bake.rays, bake.receivers, result.asset.primitives, lamps, result.knobs,
         surfaces.get(), media, bake.textures, result.asset.volumes.view(),
         static_cast<std::uint32_t>(result.glowing_volumes.size())},
        context, result.stages);
    if (!baked) return std::move(baked).error();
    result.asset.emitters = std::move(baked->emitters);
    result.error.add_part(std::string(kEmitters), baked->error.receivers_checked,
                          baked->error.rms_relative);
    const double limit = result.knobs.error_target > 0 ? result.knobs.error_target
                                                       : acceptable_error(result.knobs.quality);
    if (baked->error.rms_relative > limit) {
        result.warnings.push_back(formats::make_warning(
            "", std::string(kEmitters),
            "their light errs by " + error_percent(baked->error.rms_relative) + ", more than " +
                error_percent(limit),
            "give more --emitter-rays and --emitter-particles"));
    }
    warn_of_unlit(bake.scene, has_dark_media(bake, result.plan, subjects), result.warnings);
    warn_of_immersed(baked->immersed, result.warnings);
    return check_media(bake, lamps, context, result);
}

void bill_lamps(const CostedBake& bake, std::span<PlanEntry> plan, Bill& bill) {
    const CostRequest& request = bake.request;
    std::vector<PlanEntry*> lamps;
    for (PlanEntry& entry : plan) {
        if (entry.on && entry.subject.kind == Subject::Kind::emitter) lamps.push_back(&entry);
    }
    if (lamps.empty()) return;
    const auto for_each = [&](const char* stage, const Work& each) {
        bill.open(stage);
        for (PlanEntry* lamp : lamps) {
            bill.add(each, lamp);
        }
    };
    const double ray = kIncoherent * kCoherentRay.at(request.facts.triangles);
    const double rays = request.knobs[kEmitterRays] * request.facts.receivers;
    const double particles = kFlights * request.knobs[kEmitterParticles] * ray;
    const double points = bill_points(bake, lamps.front(), bill);
    for_each("particles of emitters", {0, particles});
    for_each("surfaces lit by emitters",
             {0, points * std::min<double>(kRaysOfScatterer, request.knobs[kEmitterRays]) * ray});
    const std::optional<Work> media = work_of_media(bake, lamps.size());
    if (media) {
        const auto share = 1 / static_cast<double>(lamps.size());
        for_each("media lit by emitters", {share * media->alone, share * media->shared});
    }
    for_each("light of emitters", {0, rays * ray});
    for (PlanEntry* lamp : lamps) {
        bill.add({0, rays / 4 * glow_steps(request.scene) * kDensityStep}, lamp);
    }
    bill.add({0, rays * ray});  // to surfaces that reflect, for all
    bill.open("self-check of emitters");
    if (media) {
        bill.open("self-check of media lit by emitters");
        bill.add({0, kLitMediaEvents * kBodyEvent.at(request.facts.triangles)});
    }
    for (PlanEntry* lamp : lamps) {
        bill.add_bytes(6 * request.facts.receivers, lamp);
    }
}

}  // namespace opaline::bake
