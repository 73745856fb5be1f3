#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bake/base/stage_log.h"
#include "bake/plan/effect.h"

namespace opaline::bake {

/// One subject of a bake in progress.
struct SubjectState {
    std::uint32_t material = 0;
    RowLayout layout;                  ///< with the tint that studies found
    std::vector<EffectState> effects;  ///< in the order of the table
};

/// All subjects that have receivers; nothing is prepared yet.
std::vector<SubjectState> begin_subjects(const BakeInputs& bake, std::span<const PlanEntry> plan,
                                         const Knobs& knobs);

/// Updates layouts and acting effects of the subjects after their studies, which are kept.
void settle_subjects(const BakeInputs& bake, std::span<const PlanEntry> plan, const Knobs& knobs,
                     std::vector<SubjectState>& subjects);

/// By material; of those without receivers as RowLayout begins.
std::vector<RowLayout> layouts_of(const formats::Scene& scene,
                                  std::span<const SubjectState> subjects);

/// The state of a material. Precondition: it has receivers.
const SubjectState& state_of(std::span<const SubjectState> subjects, std::uint32_t material);

EffectInputs inputs_of(const BakeInputs& bake, const SubjectState& subject, std::size_t effect,
                       const Knobs& knobs, const Context& context);

/// Steps that run once for each effect of each subject, in this order.
enum class Step { study, samples, prepare };
const PreparationStep& step_of(const EffectDescriptor& effect, Step step);
/// Whether a subject goes through the step of an effect that acts on it.
bool is_taken(const EffectDescriptor& effect, Step step, const formats::Material& material,
              const RowLayout& layout);

/// Runs one step for all subjects and notes its stages; a study once: what a pilot changes
/// later does not undo its choices.
/// Stops early once cancelled.
void run_step(Step step, const BakeInputs& bake, const Knobs& knobs, const Context& context,
              std::vector<SubjectState>& subjects, StageLog& log);

/// Whether it has samples that a pilot could refine: `samples` ran for some effect.
bool has_samples(std::span<const SubjectState> subjects);

}  // namespace opaline::bake
