#include "bake/pipeline/volume_costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/accuracy/pilot/pilot.h"
#include "bake/pipeline/volume_stages.h"
#include "bake/truth/draw_receivers.h"
#include "bake/volumes/volume_effects.h"
#include "bake/volumes/volume_knobs.h"
#include "bake/volumes/volume_parts.h"

namespace opaline::bake {
namespace {

// The entry of a volume with a name that is on; null where there is none.
PlanEntry* payer_of(std::span<PlanEntry> plan, std::uint32_t volume, std::string_view name) {
    const auto found = std::ranges::find_if(plan, [&](const PlanEntry& entry) {
        return entry.on && entry.subject.kind == Subject::Kind::volume &&
               entry.subject.index == volume && entry.name == name;
    });
    return found == plan.end() ? nullptr : &*found;
}

// Precondition: a volume sees surfaces.
PlanEntry* payer_of_seen(const CostedVolumes& volumes, std::span<PlanEntry> plan) {
    const auto first = std::ranges::find(volumes.layouts, true, &VolumeLayout::sees_surfaces);
    return payer_of(plan, first->whole, kSurfacesToVolumes);
}

// Walks of a volume that gather light of volumes: they fly as the others do, and sum emission along
// their flights: through half of the volume as a guess, three channels at twice the time of one.
Work glow_work(const VolumeWork& work, const VolumeLayout& layout) {
    constexpr double kShortWalk = 2, kGlowing = 0.5 * 2;
    if (!(work.nodes > 0) || layout.glow_walks == 0) {
        return {};
    }
    const double flights =
        work.walks > 0 && work.flights > 0 ? work.flights / (work.nodes * work.walks) : kShortWalk;
    const double steps = work.depth_steps / (work.nodes * work.cells);
    return {0, work.nodes * layout.glow_walks * work.tracks *
                   (flights * kVolumeFlight + kGlowing * steps * kDensityStep)};
}

// Three halves a term, four bytes a voxel of the bricks that glow: half of them as a guess.
double glow_bytes(const VolumeWork& work, const VolumeLayout& layout) {
    return 6 * work.nodes * layout.glow_terms + (layout.glows ? 2 * work.voxels : 0);
}

constexpr std::uint32_t kEncodings = 26;

bool has_truth(const EffectDescriptor& effect) {
    return effect.truth.work != nullptr;
}

// One subject's part of some receivers.
double share_of(const CostedBake& bake, const CostedSubject& subject) {
    const SceneFacts& facts = bake.request.facts;
    return facts.receivers > 0 ? facts.material[subject.material].receivers / facts.receivers : 0;
}

// Of `cheap` receivers out of all subjects', and of those whose truth is expensive as if
// `expensive` were.
void add_truth(const CostedBake& bake, double cheap, double expensive, TruthEffort effort,
               Bill& bill) {
    const auto& effects = bake.request.effects.effects;
    for (const CostedSubject& subject : bake.subjects) {
        const double drawn = subject.has_expensive_truth ? expensive : cheap;
        const SubjectCost cost = bake.cost_of(subject, share_of(bake, subject) * drawn);
        for (std::size_t e = 0; e < effects.size(); ++e) {
            if (subject.acts[e] && effects[e].truth.work != nullptr) {
                bill.add(effects[e].truth.work(cost, effort));
            }
        }
    }
}

double pilot_receivers(const CostedBake& bake) {
    const double receivers = bake.request.facts.receivers;
    return std::min(receivers,
                    std::clamp(receivers / kReceiversPerPilotReceiver, double{kLeastPilotReceivers},
                               double{kMostPilotReceivers}));
}

}  // namespace

CostedVolumes make_costed_volumes(const CostRequest& request) {
    CostedVolumes volumes;
    VolumeParts parts = part_volumes(
        request.scene, plan_volumes(request.scene, request.knobs).layouts, request.knobs);
    volumes.works = count_volume_work(parts.scene_or(request.scene), parts.layouts, request.knobs);
    volumes.layouts = std::move(parts.layouts);
    return volumes;
}

void bill_surface_light(const CostRequest& request, const CostedVolumes& volumes,
                        std::span<PlanEntry> volume_plan, Bill& bill) {
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    bill.open("surfaces that volumes see");
    bill.add(surface_light_work(input), payer_of_seen(volumes, volume_plan));
}

void bill_volumes(const CostRequest& request, const CostedVolumes& volumes,
                  std::span<PlanEntry> volume_plan, Bill& bill) {
    if (volumes.empty()) return;
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    const auto for_each = [&](std::string_view name, auto&& visit) {
        for (std::size_t i = 0; i < volumes.works.size(); ++i) {
            visit(volumes.works[i], payer_of(volume_plan, volumes.layouts[i].whole, name));
        }
    };
    bill.open("light in volumes");
    for_each(kOnceInVolumes, [&](const VolumeWork& work, PlanEntry* payer) {
        bill.add(attenuation_work(input, work), payer);
        bill.add_bytes(volume_density_bytes(work));
        bill.add_bytes(attenuated_row_bytes(work, request.knobs), payer);
    });
    if (sees_surfaces(volumes.layouts)) {
        bill.open("surfaces that volumes see");
        bill.add(seen_surfaces_work(input, volumes.works), payer_of_seen(volumes, volume_plan));
    }
    bill.open(scattering_stage(volumes.layouts));
    for (std::size_t i = 0; i < volumes.works.size(); ++i) {
        // Walks and rows that light of the sky does not need are those of surfaces.
        const VolumeLayout& layout = volumes.layouts[i];
        PlanEntry* const payer = payer_of(volume_plan, layout.whole,
                                          layout.sees_sky ? kOftenInVolumes : kSurfacesToVolumes);
        bill.add(scattering_work(input, volumes.works[i]), payer);
        bill.add_bytes(scattered_row_bytes(volumes.works[i], request.knobs), payer);
    }
    if (std::ranges::any_of(volumes.layouts, &VolumeLayout::has_nodes)) {
        const VolumeCheckOptions check =
            volume_check_effort(volumes.works, volumes.layouts, request.knobs);
        double entries = 0;  // of all rows, once for each light
        for (const VolumeWork& work : volumes.works) {
            entries +=
                work.nodes * work.bands * request.knobs[kVolumeCoefficients] * (check.probes + 1);
        }
        bill.open("self-check of volumes");
        bill.add(
            {0, static_cast<double>(check.max_events) * kTracedCollision + entries * kGatherEntry});
    }
    if (count_glowing(volumes.layouts) > 0) {
        bill.open("light of volumes");
        for (std::size_t i = 0; i < volumes.works.size(); ++i) {
            PlanEntry* const payer = payer_of(volume_plan, volumes.layouts[i].whole, kEmitters);
            bill.add(glow_work(volumes.works[i], volumes.layouts[i]), payer);
            bill.add_bytes(glow_bytes(volumes.works[i], volumes.layouts[i]), payer);
        }
        bill.open("self-check of light of volumes");
        const VolumeCheckOptions check =
            volume_check_effort(volumes.works, volumes.layouts, request.knobs);
        bill.add({0, static_cast<double>(check.max_events) * kTracedCollision});
    }
}

void bill_completion(const CostRequest& request, const CostedVolumes& volumes, double receivers,
                     double rows, std::span<PlanEntry> volume_plan, Bill& bill) {
    if (volumes.empty()) return;
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    bill.add(dimming_work(input, volumes.works, receivers, rows));
    for (std::size_t i = 0; i < volumes.works.size(); ++i) {
        const VolumeLayout& layout = volumes.layouts[i];
        bill.add(sent_light_work(input, volumes.works[i], layout, receivers),
                 payer_of(volume_plan, layout.whole, kVolumesToSurfaces));
    }
}

void bill_pilot_truth(const CostedBake& bake, Bill& bill) {
    bill.open("pilot truth", bake.kind_of("pilot truth", bake.subjects, has_truth));
    const double drawn = pilot_receivers(bake);
    add_truth(bake, drawn, std::min(drawn, double{kMostExpensivePilotReceivers}),
              {bake.request.knobs.numerical_target()}, bill);
}

void bill_fixed_trials(const CostedBake& bake, Bill& bill) {
    bill.open("pilot", bake.kind_of("pilot", bake.subjects, has_truth));
    for (const CostedSubject& subject : bake.subjects) {
        if (!subject.depends_on_trials) {
            const double own = share_of(bake, subject) * pilot_receivers(bake);
            bill.add(irradiance_work(bake.input, subject.layout.has_rows() ? own : 0,
                                     subject.layout.occluded && bake.traces_rays));
            bill.add(encode_work(bake.input, kEncodings, subject.layout.bands(), own));
        }
    }
}

// Receiver by receiver exactly.
void bill_other_trials(const CostedBake& bake, Bill& bill) {
    constexpr double kRounds = 4;
    bill.open("pilot", bake.kind_of("pilot", bake.subjects, has_truth));
    const auto& effects = bake.request.effects.effects;
    const double drawn = std::min(pilot_receivers(bake), double{kMostExpensivePilotReceivers});
    Knobs exact = bake.request.knobs;
    exact.exact_rays = true;
    const CostInput traced{exact, bake.input.triangles, bake.input.receivers};
    for (const CostedSubject& subject : bake.subjects) {
        if (!subject.depends_on_trials) continue;
        const double own = drawn * share_of(bake, subject);
        for (std::size_t e = 0; e < effects.size(); ++e) {
            if (!subject.acts[e] || effects[e].gather.work == nullptr) continue;
            // What is gathered in batches is kept from trial to trial.
            const bool is_kept = effects[e].gather.gather_batch != nullptr;
            const SubjectCost in_bake = bake.cost_of(subject, (is_kept ? 1 : kRounds) * own);
            const SubjectCost cost{traced,         in_bake.material,  in_bake.facts,
                                   in_bake.layout, in_bake.receivers, in_bake.traces_rays};
            bill.add(effects[e].gather.work(cost));
        }
        bill.add(encode_work(bake.input, kEncodings * subject.layout.terms(),
                             subject.layout.bands(), own));
    }
}

void bill_self_check(const CostedBake& bake, Bill& bill) {
    bill.open("self-check", bake.kind_of("self-check", bake.subjects, has_truth));
    const auto drawn = static_cast<double>(count_checked(
        static_cast<std::size_t>(bake.request.facts.receivers), bake.request.knobs.cubemap_size));
    const double expensive = drawn / std::max(1.0, std::ceil(drawn / double{kMostExpensiveChecks}));
    constexpr double kPlaces = 2;  // at receivers, and between them
    add_truth(bake, kPlaces * drawn, kPlaces * expensive, {}, bill);
}

}  // namespace opaline::bake
