#include "bake/plan/bake_plan.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

#include "bake/plan/effect.h"
#include "bake/plan/plan_input.h"

namespace opaline::bake {
namespace {

std::size_t count_decisions(const EffectTable& effects, const PlanInput& input) {
    std::size_t count = 0;
    for_each_rule(effects, [&](const EffectDescriptor&, const DecisionRule& rule, std::uint8_t) {
        count += rule.concerns(input) ? 1 : 0;
    });
    return count;
}

// Those whose key is `value`. Sorted by the key.
template <class Value, class Key>
std::span<const PlanEntry> equal_entries(std::span<const PlanEntry> plan, Value value, Key key) {
    const auto first = std::ranges::lower_bound(plan, value, {}, key);
    const auto last = std::ranges::upper_bound(plan, value, {}, key);
    return {first, last};
}

}  // namespace

std::vector<Subject> list_subjects(const formats::Scene& scene, const SceneFacts& facts) {
    assert(facts.material.size() == scene.materials.size());
    std::vector<Subject> subjects;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (facts.material[m].receivers > 0) {
            subjects.push_back(
                {Subject::Kind::material, m, "material '" + scene.materials[m].name + "'"});
        }
    }
    return subjects;
}

std::vector<PlanEntry> plan_bake(const EffectTable& effects, const formats::Scene& scene,
                                 const SceneFacts& facts, const Knobs& knobs,
                                 std::span<const Prepared* const> studies) {
    assert(studies.empty() || studies.size() == scene.materials.size() * effects.effects.size());
    std::vector<PlanEntry> plan;
    for (const Subject& subject : list_subjects(scene, facts)) {
        PlanInput input{scene.materials[subject.index], facts.material[subject.index], knobs};
        input.least_bound = least_bound(knobs, count_decisions(effects, input));
        std::vector<PlanEntry> decisions;
        const auto decide = [&](const EffectDescriptor& effect, const DecisionRule& rule,
                                std::uint8_t number) {
            input.earlier = decisions;
            if (!rule.concerns(input)) return;
            const auto e = static_cast<std::size_t>(&effect - effects.effects.data());
            input.study =
                studies.empty() ? nullptr : studies[subject.index * effects.effects.size() + e];
            PlanEntry entry = rule.decide(input);
            entry.effect = effect.id;
            entry.rule = number;
            entry.name = rule.name;
            entry.subject = subject;
            tell_forced(entry);
            decisions.push_back(std::move(entry));
        };
        for_each_rule(effects, decide);
        std::ranges::move(decisions, std::back_inserter(plan));
    }
    return plan;
}

double find_model_error(std::span<const PlanEntry> plan) {
    double most = 0;
    plan = entries_of(plan, Subject::Kind::material);
    while (!plan.empty()) {
        const auto own = entries_of(plan, plan.front().subject.index);
        double square = 0;
        for (const PlanEntry& entry : own) {
            square += entry.model_error * entry.model_error;
        }
        most = std::max(most, std::sqrt(square));
        plan = plan.subspan(own.size());
    }
    return most;
}

std::string list_choices(std::span<const PlanEntry> plan) {
    std::vector<std::string_view> seen;
    std::string list;
    for (const PlanEntry& entry : entries_of(plan, Subject::Kind::material)) {
        if (!entry.choice.empty() && std::ranges::find(seen, entry.choice) == seen.end()) {
            seen.push_back(entry.choice);
            list += (list.empty() ? "" : ", ") + std::string(entry.choice);
        }
    }
    return list;
}

const PlanEntry* find_entry(std::span<const PlanEntry> plan, std::string_view name,
                            std::uint32_t material) {
    const auto own = entries_of(plan, material);
    const auto entry = std::ranges::find(own, name, &PlanEntry::name);
    return entry == own.end() ? nullptr : &*entry;
}

std::span<const PlanEntry> entries_of(std::span<const PlanEntry> plan, std::uint32_t material) {
    return equal_entries(entries_of(plan, Subject::Kind::material), material,
                         [](const PlanEntry& e) { return e.subject.index; });
}

std::span<const PlanEntry> entries_of(std::span<const PlanEntry> plan, Subject::Kind kind) {
    return equal_entries(plan, kind, [](const PlanEntry& e) { return e.subject.kind; });
}

bool is_on(std::span<const PlanEntry> plan, std::string_view name) {
    return std::ranges::any_of(
        plan, [&](const PlanEntry& entry) { return entry.on && entry.name == name; });
}

bool is_on(std::span<const PlanEntry> plan, Subject::Kind kind) {
    return std::ranges::any_of(entries_of(plan, kind), &PlanEntry::on);
}

void replace_entries(Subject::Kind kind, std::span<const PlanEntry> entries,
                     std::vector<PlanEntry>& plan) {
    const auto old = entries_of(plan, kind);
    const auto first = plan.begin() + (old.data() - plan.data());
    const auto at = plan.erase(first, first + static_cast<std::ptrdiff_t>(old.size()));
    plan.insert(at, entries.begin(), entries.end());
}

}  // namespace opaline::bake
