#include "bake/choose_knobs.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "bake/pilot/refinement.h"
#include "bake/prepare_media.h"
#include "bake/run_stage.h"

namespace opaline::bake {
namespace {

// One round of the pilot.
struct TriedRound {
    PilotChoice choice;
    MediaStages media;
    bool has_samples = false;

    PilotRound outcome() const {
        return {choice.knobs, has_samples, choice.finest_error, choice.smooth_error};
    }
};

TriedRound try_round(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                     const OpaquePairs& opaque, const Knobs& knobs,
                     std::span<const TestLight> lights, const Context& context,
                     BakeResult& result) {
    TriedRound round;
    round.media = prepare_media(pilot, knobs, context, result);
    round.has_samples = std::any_of(round.media.begin(), round.media.end(),
                                    [](const auto& m) { return m.second.multiple.has_value(); });
    round.choice = run_stage(result, "pilot", [&](std::uint64_t&) {
        return choose_row_knobs(pilot, receivers, opaque, knobs, round.media, lights, context);
    });
    for (const PilotTrial& trial : round.choice.trials) {
        result.accuracy->trials.push_back({knobs.cubemap_size, knobs.samples_per_path, trial});
    }
    return round;
}

// What the user gave: the pilot could not change it.
std::string name_given(const Knobs& knobs) {
    std::string given;
    for (const auto& [is_given, option] : {std::pair{knobs.fixed.cubemap, "--cubemap"},
                                           {knobs.fixed.coefficients, "--coefficients"},
                                           {knobs.exact_samples, "--samples"},
                                           {knobs.fixed.tolerance, "--epsilon"},
                                           {knobs.fixed.depth_samples, "--depth-samples"},
                                           {knobs.phase_terms != 0, "--phase-terms"}}) {
        given += is_given ? (given.empty() ? "" : ", ") + std::string(option) : "";
    }
    return given;
}

}  // namespace

MediaStages choose_knobs(const PilotScene& pilot, std::vector<TestLight>& lights,
                         const Context& context, BakeResult& result) {
    Knobs& knobs = result.knobs;
    result.accuracy = AccuracyReport{knobs.error_target, 0, 0, false, {}};
    const std::vector<PilotReceiver> receivers =
        run_stage(result, "pilot truth",
                  [&](std::uint64_t&) { return find_pilot_truth(pilot, knobs, lights, context); });
    Refinement opaque_alone, whole;
    TriedRound best;
    std::optional<Knobs> next = knobs;
    while (next && !context.cancelled()) {
        const Knobs tried = *next;
        project_test_lights(lights, tried.cubemap_size);
        // Samples of media are not worth taking where the opaque receivers need more texels.
        const OpaquePairs opaque = run_stage(result, "pilot", [&](std::uint64_t&) {
            return measure_opaque(pilot, receivers, tried, lights, context);
        });
        const double floor = find_direct_floor(opaque, receivers);
        if (floor > tried.error_target && !whole.base &&
            learn(opaque_alone, {tried, false, floor, 0}) && (next = next_knobs(opaque_alone))) {
            continue;
        }
        if (!whole.base) {
            whole = opaque_alone;  // what texels do
            whole.base.reset();
        }
        TriedRound round = try_round(pilot, receivers, opaque, tried, lights, context, result);
        if (learn(whole, round.outcome()) || round.choice.met) {
            best = std::move(round);
        }
        next = best.choice.met ? std::nullopt : next_knobs(whole);
    }
    if (context.cancelled()) {
        return {};
    }
    knobs = best.choice.knobs;
    project_test_lights(lights, knobs.cubemap_size);
    result.accuracy->predicted = best.choice.error;
    result.accuracy->likely = best.choice.likely;
    result.accuracy->met = best.choice.met;
    return std::move(best.media);
}

void warn_of_missed_target(const BakeResult& result, std::vector<formats::Diagnostic>& warnings) {
    const AccuracyReport& accuracy = *result.accuracy;
    const auto percent = [](double error) {
        const std::string text = std::to_string(1e-3 * std::round(1e5 * error));
        return text.substr(0, text.find('.') + 3) + " %";
    };
    if (!accuracy.met) {
        const std::string given = name_given(result.knobs);
        warnings.push_back(formats::make_warning(
            "", "--error",
            percent(accuracy.target) + " is out of reach: " + percent(accuracy.likely) +
                " is the least that was found worth its cost, with " +
                std::to_string(result.knobs.cubemap_size) + " texels along a face",
            given.empty() ? "allow a larger error; more vertices where shadows end, or a finer "
                            "--cubemap, come closer"
                          : "leave " + given + " out"));
    } else if (result.error.at_receivers.rms_relative > accuracy.target) {
        warnings.push_back(formats::make_warning(
            "", "--error",
            "the self-check measured " + percent(result.error.at_receivers.rms_relative) +
                " at vertices, more than the " + percent(accuracy.target) + " asked for",
            "ask for a little less"));
    }
}

}  // namespace opaline::bake
