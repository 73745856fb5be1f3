#include "bake/pipeline/accuracy_costs.h"

#include <algorithm>
#include <cmath>

#include "bake/accuracy/pilot/pilot.h"
#include "bake/truth/draw_receivers.h"

namespace opaline::bake {
namespace {

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
        if (!subject.depends_on_trials) {
            continue;
        }
        const double own = drawn * share_of(bake, subject);
        for (std::size_t e = 0; e < effects.size(); ++e) {
            if (!subject.acts[e] || effects[e].gather.work == nullptr) {
                continue;
            }
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
