#include "bake/pipeline/costed_bake.h"

#include <algorithm>
#include <utility>

#include "bake/effects/rows/subject_states.h"

namespace opaline::bake {
namespace {

bool gathers(const EffectDescriptor& effect, const RowLayout& layout) {
    return effect.gather.work != nullptr &&
           (effect.gather.applies == nullptr || effect.gather.applies(layout));
}

// Calls visit(entry, layout before the decision, layout after it) for all decisions of an effect.
template <class Visit>
void for_each_growth(const CostedBake& bake, const CostedSubject& subject, Visit&& visit) {
    const EffectTable& effects = bake.request.effects;
    RowLayout grown = subject.layout;
    grown.constant = false;
    grown.harmonics = grown.view_harmonics = grown.straight_harmonics = 0;
    for (PlanEntry& entry : subject.decisions) {
        const RowLayout before = grown;
        RowLayout after = grown;
        rule_of(effects, entry).lay_out(entry, after);
        grown.constant = after.constant;
        grown.harmonics = after.harmonics;
        grown.view_harmonics = std::min(after.view_harmonics, subject.layout.view_harmonics);
        grown.straight_harmonics =
            std::min(after.straight_harmonics, subject.layout.straight_harmonics);
        visit(entry, before, grown);
    }
}

std::uint32_t rows_of(const RowLayout& layout) {
    return layout.has_rows() ? layout.terms() - (layout.separate && !layout.constant ? 1 : 0) : 0;
}

}  // namespace

SubjectCost CostedBake::cost_of(const CostedSubject& subject, double receivers) const {
    return {input,
            request.scene.materials[subject.material],
            request.facts.material[subject.material],
            subject.layout,
            receivers,
            traces_rays};
}

PlanEntry* CostedBake::payer(const CostedSubject& subject, std::size_t effect) const {
    const Effect id = request.effects.effects[effect].id;
    PlanEntry* first = nullptr;
    for (PlanEntry& entry : subject.decisions) {
        if (entry.on && entry.rule == 0 && entry.effect == id) return &entry;
        const bool fills =
            entry.on && entry.rule == 0 && request.effects[entry.effect].gather.work != nullptr;
        first = first == nullptr && fills ? &entry : first;
    }
    return first;
}

std::string CostedBake::kind_of(
    std::string stage, std::span<const CostedSubject> some,
    const std::function<bool(const EffectDescriptor&)>& takes_part) const {
    const auto any = [&](auto&& holds) -> bool { return std::ranges::any_of(some, holds); };
    const auto& effects = request.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        if (takes_part(effects[e]) &&
            any([e](const CostedSubject& s) -> bool { return s.acts[e]; })) {
            stage += " + " + std::string(effects[e].name);
        }
    }
    return any([](const CostedSubject& s) { return s.layout.all_orders; }) ? stage + " by walks"
                                                                           : stage;
}

CostedBake make_costed_bake(const CostRequest& request, std::vector<PlanEntry>& plan) {
    CostedBake bake{
        request, {request.knobs, request.facts.triangles, request.facts.receivers}, {}, false};
    std::vector<RowLayout> layouts;
    for (const Subject& subject : list_subjects(request.scene, request.facts)) {
        CostedSubject own;
        own.material = subject.index;
        const auto entries = entries_of(plan, subject.index);
        own.decisions = std::span(plan).subspan(
            static_cast<std::size_t>(entries.data() - plan.data()), entries.size());
        own.layout = layout_material(request.effects, request.scene.materials[subject.index],
                                     entries, request.knobs);
        for (const EffectDescriptor& effect : request.effects.effects) {
            const bool acts = acts_on(effect, entries, own.layout);
            own.acts.push_back(acts);
            own.has_expensive_truth =
                own.has_expensive_truth || (acts && effect.truth.is_expensive);
            own.depends_on_trials = own.depends_on_trials || (acts && !effect.pilot.empty());
        }
        layouts.push_back(own.layout);
        bake.subjects.push_back(std::move(own));
    }
    bake.traces_rays = needs_hierarchy(layouts);
    return bake;
}

Work work_of_points(const CostedBake& bake, const CostedSubject& subject, const Knobs& knobs,
                    double points, const std::function<bool(std::size_t effect)>& counts) {
    const CostRequest& request = bake.request;
    const auto& effects = request.effects.effects;
    const CostInput input{knobs, request.facts.triangles, request.facts.receivers};
    const SubjectCost cost = bake.cost_of(subject, points).with(input, subject.layout);
    Work all;
    for (std::size_t f = 0; f < effects.size(); ++f) {
        if (!subject.acts[f] || !counts(f)) continue;
        for (const Step step : {Step::samples, Step::prepare}) {
            const auto work = step_of(effects[f], step).work;
            if (work != nullptr && is_taken(effects[f], step, cost.material, subject.layout)) {
                all += work(cost);
            }
        }
        if (gathers(effects[f], subject.layout)) all += effects[f].gather.work(cost);
    }
    return all;
}

void bill_rows(const CostedBake& bake, const CostedSubject& subject, double receivers, Bill& bill) {
    const EffectTable& effects = bake.request.effects;
    for (std::size_t e = 0; e < effects.effects.size(); ++e) {
        const EffectDescriptor& effect = effects.effects[e];
        if (!subject.acts[e] || !gathers(effect, subject.layout)) continue;
        // Sets share their batches: each pays for its receivers' part of those of the subject.
        const SubjectCost cost =
            bake.cost_of(subject, bake.request.facts.material[subject.material].receivers);
        const double share = receivers / cost.receivers;
        const auto of_share = [share](const Work& work) {
            return Work{share * work.alone, share * work.shared};
        };
        const Work all = of_share(effect.gather.work(cost));
        Work of_parts;
        for_each_growth(
            bake, subject, [&](PlanEntry& entry, const RowLayout& before, const RowLayout& after) {
                if (entry.effect == effect.id && entry.rule > 0 && entry.on &&
                    rows_of(after) > rows_of(before)) {
                    const Work growth = of_share(effect.gather.work(cost.with(cost.input, after)) -
                                                 effect.gather.work(cost.with(cost.input, before)));
                    bill.add(growth, &entry);
                    of_parts += growth;
                }
            });
        bill.add(all - of_parts, bake.payer(subject, e));
    }
}

void bill_encoding(const CostedBake& bake, const CostedSubject& subject, double receivers,
                   Bill& bill) {
    const std::uint32_t bands = subject.layout.bands();
    const double bytes =
        receivers *
        static_cast<double>(row_bytes(bake.request.knobs,
                                      subject.layout.translucent || subject.layout.sheet, bands));
    const auto bill_some = [&](std::uint32_t rows, PlanEntry* payer) {
        // Local rows are gathered by texel and transformed band by band, as grey ones are; the
        // others are gathered as coefficients.
        bill.add(subject.layout.at_entry ? encode_work(bake.input, rows * bands, 1, receivers)
                                         : encode_work(bake.input, rows, bands, receivers),
                 payer);
        bill.add_bytes(rows * bytes, payer);
    };
    std::uint32_t paid = 0;
    for_each_growth(bake, subject,
                    [&](PlanEntry& entry, const RowLayout& before, const RowLayout& after) {
                        const std::uint32_t rows = rows_of(after) - rows_of(before);
                        bill_some(rows, entry.on ? &entry : nullptr);
                        paid += rows;
                    });
    bill_some(subject.layout.terms() - paid, nullptr);  // of rows that nothing fills
}

Bill::Bill(const StageRates& rates, unsigned threads, std::vector<PlanEntry>& plan)
    : rates_(rates), plan_(plan), threads_(threads) {
    for (PlanEntry& entry : plan) {
        entry.predicted_seconds = 0;
        entry.predicted_bytes = 0;
    }
}

void Bill::open(std::string stage, std::string kind) {
    kind = kind.empty() ? stage : std::move(kind);
    factor_ = rates_.factor(kind);
    cost.stages.push_back({std::move(stage), std::move(kind), 0, 0});
}

void Bill::add(const Work& work, PlanEntry* payer) {
    const double seconds = factor_ * (work.alone + work.shared / threads_);
    cost.stages.back().work += work.alone + work.shared;
    cost.stages.back().seconds += seconds;
    cost.seconds += seconds;
    (payer != nullptr ? payer->predicted_seconds : cost.shared_seconds) += seconds;
}

void Bill::add_bytes(double bytes, PlanEntry* payer) {
    const auto whole = static_cast<std::uint64_t>(bytes);
    cost.bytes += whole;
    (payer != nullptr ? payer->predicted_bytes : cost.shared_bytes) += whole;
}

PlanEntry* Bill::payer(Subject::Kind kind, std::uint32_t subject, std::string_view name) const {
    const auto found = std::ranges::find_if(plan_, [&](const PlanEntry& entry) {
        return entry.on && entry.subject.kind == kind && entry.subject.index == subject &&
               entry.name == name;
    });
    return found == plan_.end() ? nullptr : &*found;
}

}  // namespace opaline::bake
