#include "bake/pipeline/volume_costs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bake/check/pilot/pilot.h"
#include "bake/effects/volumes/lamp_walks.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/effects/volumes/volume_knobs.h"
#include "bake/effects/volumes/volume_parts.h"
#include "bake/lights/test_lights.h"
#include "bake/pipeline/volume_stages.h"

namespace opaline::bake {
namespace {

// Precondition: a volume sees surfaces.
PlanEntry* payer_of_seen(const CostedVolumes& volumes, Bill& bill) {
    const auto first = std::ranges::find(volumes.layouts, true, &VolumeLayout::sees_surfaces);
    return bill.payer(Subject::Kind::volume, first->whole, kSurfacesToVolumes);
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

// Walks of a volume that gather light of lamps, and those of all lamps that arrives: a shadow ray
// and a march each, at collisions and around nodes.
struct LampWork {
    Work walks, of_lamp;
};
LampWork lamp_work(const CostInput& input, const VolumeWork& work, const VolumeLayout& layout) {
    constexpr double kShortWalk = 2, kFewCollisions = 0.5, kApart = 4, kHalfWay = 0.5;
    if (!(work.nodes > 0) || layout.glow_walks == 0) return {};
    const bool is_counted = work.walks > 0 && work.flights > 0;
    const double counted = work.nodes * work.walks;
    const double flights = is_counted ? work.flights / counted : kShortWalk;
    const double collisions = is_counted ? work.collisions / counted : kFewCollisions;
    const double walks = work.nodes * layout.glow_walks * work.tracks;
    const double steps = kHalfWay * work.depth_steps / (work.nodes * work.cells);
    const double ray = input.triangles > 0 ? kApart * kCoherentRay.at(input.triangles) : 0;
    const double arrivals = walks * collisions + work.nodes * kStraightPoints;
    return {{0, walks * flights * (kVolumeFlight + ray)},
            {0, arrivals * (steps * kDensityStep + ray)}};
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

void bill_surface_light(const CostRequest& request, const CostedVolumes& volumes, Bill& bill) {
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    bill.open("surfaces that volumes see");
    bill.add(surface_light_work(input), payer_of_seen(volumes, bill));
}

void bill_volumes(const CostRequest& request, const CostedVolumes& volumes, Bill& bill) {
    if (volumes.empty()) return;
    const std::vector<VolumeLayout>& layouts = volumes.layouts;  // for clang 14's lambdas
    const std::vector<VolumeWork>& works = volumes.works;
    const Knobs& knobs = request.knobs;
    const double receivers = request.facts.receivers;
    const CostInput input{knobs, request.facts.triangles, receivers};
    const auto payer = [&](std::size_t i, std::string_view name) {
        return bill.payer(Subject::Kind::volume, layouts[i].whole, name);
    };
    const VolumeCheckOptions check = volume_check_effort(works, layouts, knobs);
    const double check_seconds = static_cast<double>(check.max_events) * kTracedCollision;
    bill.open("light in volumes");
    for (std::size_t i = 0; i < works.size(); ++i) {
        bill.add(attenuation_work(input, works[i]), payer(i, kOnceInVolumes));
        bill.add_bytes(volume_density_bytes(works[i]));
        bill.add_bytes(attenuated_row_bytes(works[i], knobs), payer(i, kOnceInVolumes));
    }
    if (sees_surfaces(layouts)) {
        bill.open("surfaces that volumes see");
        bill.add(seen_surfaces_work(input, works), payer_of_seen(volumes, bill));
    }
    bill.open(scattering_stage(layouts));
    for (std::size_t i = 0; i < works.size(); ++i) {
        // Walks and rows that light of the sky does not need are those of surfaces.
        PlanEntry* const own = payer(i, layouts[i].sees_sky ? kOftenInVolumes : kSurfacesToVolumes);
        bill.add(scattering_work(input, works[i]), own);
        bill.add_bytes(scattered_row_bytes(works[i], knobs), own);
    }
    if (std::ranges::any_of(layouts, &VolumeLayout::has_nodes)) {
        double entries = 0;  // of all rows, once for each light
        for (const VolumeWork& work : works) {
            entries += work.nodes * work.bands * knobs[kVolumeCoefficients] * (check.probes + 1);
        }
        bill.open("self-check of volumes");
        bill.add({0, check_seconds + entries * kGatherEntry});
    }
    if (count_glowing(layouts) > 0) {
        bill.open("light of volumes");
        for (std::size_t i = 0; i < works.size(); ++i) {
            bill.add(glow_work(works[i], layouts[i]), payer(i, kEmitters));
            bill.add_bytes(glow_bytes(works[i], layouts[i]), payer(i, kEmitters));
        }
        bill.open("self-check of light of volumes");
        bill.add({0, check_seconds});
    }
    std::vector<PlanEntry*> lamps;
    for (std::uint32_t i = 0; i < list_lamps(request.scene).size(); ++i) {
        PlanEntry* const own = bill.payer(Subject::Kind::emitter, i, kEmitters);
        if (own != nullptr) lamps.push_back(own);
    }
    const bool are_lit =
        std::ranges::any_of(layouts, [](const auto& own) { return own.glow_terms > 0; });
    if (lamps.empty() || !are_lit) return;
    bill.open(kLampsInVolumes);
    for (std::size_t i = 0; i < works.size(); ++i) {
        const LampWork work = lamp_work(input, works[i], layouts[i]);
        const double share = 1 / static_cast<double>(lamps.size());
        for (PlanEntry* const lamp : lamps) {
            bill.add({0, share * work.walks.shared + work.of_lamp.shared}, lamp);
            bill.add_bytes(6 * works[i].nodes * layouts[i].glow_terms, lamp);
        }
    }
    bill.open("self-check of emitters in volumes");
    bill.add({0, static_cast<double>(kEventsOfLamps) * check_seconds});
}

void bill_completion(const CostRequest& request, const CostedVolumes& volumes, double receivers,
                     double rows, Bill& bill) {
    if (volumes.empty()) return;
    const CostInput input{request.knobs, request.facts.triangles, request.facts.receivers};
    bill.add(dimming_work(input, volumes.works, receivers, rows));
    for (std::size_t i = 0; i < volumes.works.size(); ++i) {
        const VolumeLayout& layout = volumes.layouts[i];
        bill.add(sent_light_work(input, volumes.works[i], layout, receivers),
                 bill.payer(Subject::Kind::volume, layout.whole, kVolumesToSurfaces));
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
            bill.add(effects[e].gather.work(in_bake.with(traced, subject.layout)));
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
