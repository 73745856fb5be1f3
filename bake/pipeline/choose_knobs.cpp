#include "bake/pipeline/choose_knobs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bake/check/pilot/refinement.h"
#include "bake/pipeline/unmet_requests.h"

namespace opaline::bake {
namespace {

// One round of the pilot: the samples that it took stay with it.
struct TriedRound {
    PilotChoice choice;
    std::vector<PreparedPtr> samples;  // subject by subject, effect by effect
    bool has_samples = false;

    PilotRound outcome() const {
        return {choice.knobs, has_samples, choice.finest_error, choice.smooth_error};
    }
};

template <class Visit>
void for_each_samples(std::vector<SubjectState>& subjects, Visit&& visit) {
    for (SubjectState& subject : subjects) {
        for (EffectState& effect : subject.effects) {
            visit(effect.samples);
        }
    }
}

TriedRound try_round(const BakeInputs& bake, const Knobs& knobs, const Context& context,
                     std::span<const PilotReceiver> receivers, const FixedPairs& fixed,
                     PilotState& state) {
    TriedRound round;
    run_step(Step::samples, bake, knobs, context, state.subjects, state.log);
    round.has_samples = has_samples(state.subjects);
    const PilotScene pilot{bake, state.subjects, state.lights, context};
    round.choice = run_stage(state.log, "pilot", [&](std::uint64_t&) {
        return choose_row_knobs(pilot, receivers, fixed, knobs);
    });
    for (const PilotTrial& trial : round.choice.trials) {
        state.report.trials.push_back({knobs, trial});
    }
    for_each_samples(state.subjects,
                     [&](PreparedPtr& samples) { round.samples.push_back(std::move(samples)); });
    return round;
}

// Names of the options that the user fixed.
std::string name_given(const EffectTable& effects, const Knobs& knobs) {
    std::string given;
    const auto name = [&](bool is_given, std::string_view option) {
        given += is_given ? (given.empty() ? "" : ", ") + std::string(option) : "";
    };
    name(knobs.cubemap_given, "--cubemap");
    name(knobs.coefficients_given, "--coefficients");
    for (const EffectDescriptor& effect : effects.effects) {
        for (const KnobSpec* knob : effect.knobs) {
            name(knobs.is_given(*knob), knob->option);
        }
    }
    return given;
}

}  // namespace

Knobs choose_knobs(const BakeInputs& bake, const Knobs& wanted, const Context& context,
                   PilotState state) {
    state.report.target = wanted.error_target;
    state.report.model = wanted.model_error;
    state.report.numerical = wanted.numerical_target();
    const auto scene = [&] { return PilotScene{bake, state.subjects, state.lights, context}; };
    const std::vector<PilotReceiver> receivers =
        run_stage(state.log, "pilot truth",
                  [&](std::uint64_t&) { return find_pilot_truth(scene(), wanted); });
    Refinement fixed_alone, whole;
    TriedRound best;
    std::optional<Knobs> next = wanted;
    while (next && !context.cancelled()) {
        const Knobs tried = *next;
        project_test_lights(state.lights, tried.cubemap_size);
        // No samples are taken yet where receivers without samples already need more texels.
        const FixedPairs fixed = run_stage(state.log, "pilot", [&](std::uint64_t&) {
            return measure_fixed(scene(), receivers, tried);
        });
        const double floor = find_fixed_floor(fixed, receivers);
        if (floor > tried.numerical_target() && !whole.base &&
            learn(fixed_alone, {tried, false, floor, 0}) &&
            (next = next_knobs(bake.effects, fixed_alone))) {
            continue;
        }
        if (!whole.base) {
            whole = fixed_alone;  // keeps what was learned about texels
            whole.base.reset();
        }
        TriedRound round = try_round(bake, tried, context, receivers, fixed, state);
        if (learn(whole, round.outcome()) || round.choice.met) {
            best = std::move(round);
        }
        next = best.choice.met ? std::nullopt : next_knobs(bake.effects, whole);
    }
    if (context.cancelled()) return wanted;
    auto samples = best.samples.begin();
    for_each_samples(state.subjects, [&](PreparedPtr& own) { own = std::move(*samples++); });
    project_test_lights(state.lights, best.choice.knobs.cubemap_size);
    state.report.predicted = best.choice.error;
    state.report.likely = best.choice.likely;
    state.report.met = best.choice.met;
    return std::move(best.choice.knobs);
}

void warn_of_missed_target(const EffectTable& effects, const AccuracyReport& accuracy,
                           const Knobs& knobs, double measured,
                           std::vector<formats::Diagnostic>& warnings) {
    const auto percent = [](double error) {
        const std::string text = std::to_string(1e-3 * std::round(1e5 * error));
        return text.substr(0, text.find('.') + 3) + " %";
    };
    if (auto missed = describe_missed_models(accuracy.target, accuracy.model)) {
        warnings.push_back(std::move(*missed));
    }
    const std::string left =
        percent(accuracy.numerical) +
        (accuracy.model > accuracy.target
             ? ", which is asked for where the models err by " + percent(accuracy.model)
         : accuracy.model > 0
             ? ", what the models leave of the " + percent(accuracy.target) + " asked for"
             : "");
    if (!accuracy.met) {
        const std::string given = name_given(effects, knobs);
        warnings.push_back(formats::make_warning(
            "", "--error",
            left + " is out of reach: " + percent(accuracy.likely) +
                " is the least that was found worth its cost, with " +
                std::to_string(knobs.cubemap_size) + " texels along a face",
            given.empty() ? "allow a larger error; more vertices where shadows end, or a finer "
                            "--cubemap, come closer"
                          : "leave " + given + " out"));
    } else if (measured > accuracy.numerical) {
        warnings.push_back(formats::make_warning("", "--error",
                                                 "the self-check measured " + percent(measured) +
                                                     " at vertices, more than " + left +
                                                     (accuracy.model > 0 ? "" : " asked for"),
                                                 "ask for a little less"));
    }
}

}  // namespace opaline::bake
