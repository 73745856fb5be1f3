#include "bake/effects/rows/subject_states.h"

#include <algorithm>
#include <cassert>
#include <string>
#include <utility>

#include "bake/exchange/other_light.h"

namespace opaline::bake {
namespace {

PreparedPtr& result_of(EffectState& state, Step step) {
    return step == Step::study     ? state.study
           : step == Step::samples ? state.samples
                                   : state.prepared;
}

void take_tints(const EffectTable& effects, SubjectState& subject) {
    for (std::size_t e = 0; e < subject.effects.size(); ++e) {
        const auto tint = effects.effects[e].tint;
        if (tint != nullptr && subject.effects[e].study != nullptr) {
            subject.layout.tint = tint(*subject.effects[e].study);
        }
    }
}

}  // namespace

std::vector<SubjectState> begin_subjects(const BakeInputs& bake, std::span<const PlanEntry> plan,
                                         const Knobs& knobs) {
    std::vector<SubjectState> subjects;
    for (const Subject& subject : list_subjects(bake.scene, bake.facts)) {
        SubjectState state;
        state.material = subject.index;
        state.effects.resize(bake.effects.effects.size());
        subjects.push_back(std::move(state));
    }
    settle_subjects(bake, plan, knobs, subjects);
    return subjects;
}

void settle_subjects(const BakeInputs& bake, std::span<const PlanEntry> plan, const Knobs& knobs,
                     std::vector<SubjectState>& subjects) {
    for (SubjectState& state : subjects) {
        const auto decisions = entries_of(plan, state.material);
        state.layout =
            layout_material(bake.effects, bake.scene.materials[state.material], decisions, knobs);
        for (std::size_t e = 0; e < state.effects.size(); ++e) {
            const EffectDescriptor& effect = bake.effects.effects[e];
            // Where light leaves at its entry, one effect adds the row, and others scale it.
            const bool helps = state.layout.at_entry && effect.add_at_entry != nullptr;
            state.effects[e].acts =
                acts_on(effect, decisions, state.layout) &&
                (has_environment(bake.light) || effect.adds_other_light || helps);
        }
        take_tints(bake.effects, state);
    }
}

std::vector<RowLayout> layouts_of(const formats::Scene& scene,
                                  std::span<const SubjectState> subjects) {
    std::vector<RowLayout> layouts(scene.materials.size());
    for (const SubjectState& subject : subjects) {
        layouts[subject.material] = subject.layout;
    }
    return layouts;
}

const SubjectState& state_of(std::span<const SubjectState> subjects, std::uint32_t material) {
    const auto found = std::find_if(subjects.begin(), subjects.end(),
                                    [&](const SubjectState& s) { return s.material == material; });
    assert(found != subjects.end());
    return *found;
}

EffectInputs inputs_of(const BakeInputs& bake, const SubjectState& subject, std::size_t effect,
                       const Knobs& knobs, const Context& context) {
    return {bake,    subject.material, subject.layout,         knobs,
            context, subject.effects,  subject.effects[effect]};
}

const PreparationStep& step_of(const EffectDescriptor& effect, Step step) {
    return step == Step::study     ? effect.study
           : step == Step::samples ? effect.samples
                                   : effect.prepare;
}

bool is_taken(const EffectDescriptor& effect, Step step, const formats::Material& material,
              const RowLayout& layout) {
    const PreparationStep& own = step_of(effect, step);
    return own.run != nullptr && (own.applies == nullptr || own.applies(material, layout));
}

void run_step(Step step, const BakeInputs& bake, const Knobs& knobs, const Context& context,
              std::vector<SubjectState>& subjects, StageLog& log) {
    const auto& effects = bake.effects.effects;
    for (std::size_t e = 0; e < effects.size(); ++e) {
        const PreparationStep& own = step_of(effects[e], step);
        std::vector<SubjectState*> concerned;
        for (SubjectState& subject : subjects) {
            const bool is_done = step == Step::study && subject.effects[e].study != nullptr;
            if (!is_done && subject.effects[e].acts &&
                is_taken(effects[e], step, bake.scene.materials[subject.material],
                         subject.layout)) {
                concerned.push_back(&subject);
            }
        }
        const std::string group =
            std::string(effects[e].name) + ": " +
            std::string(own.stage.substr(0, own.stage.rfind(own.by_subject ? " of" : "")));
        const auto run = [&](SubjectState& subject, std::uint64_t& rays) {
            result_of(subject.effects[e], step) =
                own.run(inputs_of(bake, subject, e, knobs, context), rays);
            if (step == Step::study) take_tints(bake.effects, subject);
            return 0;
        };
        const auto run_all = [&](std::uint64_t& rays) {
            for (SubjectState* subject : concerned) {
                run(*subject, rays);
            }
            return 0;
        };
        std::uint64_t uncounted = 0;
        if (concerned.empty() || context.cancelled()) continue;
        if (own.stage.empty()) {
            run_all(uncounted);
        } else if (!own.by_subject) {
            run_stage(log, std::string(own.stage), group, run_all);
        } else {
            for (SubjectState* subject : concerned) {
                run_stage(log,
                          std::string(own.stage) + " material '" +
                              bake.scene.materials[subject->material].name + "'",
                          group, [&](std::uint64_t& rays) { return run(*subject, rays); });
            }
        }
    }
}

bool has_samples(std::span<const SubjectState> subjects) {
    return std::any_of(subjects.begin(), subjects.end(), [](const SubjectState& s) {
        return std::any_of(s.effects.begin(), s.effects.end(),
                           [](const EffectState& e) { return e.samples != nullptr; });
    });
}

}  // namespace opaline::bake
