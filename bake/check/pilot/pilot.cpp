#include "bake/check/pilot/pilot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/check/pilot/pilot_rows.h"
#include "bake/check/subject_truth.h"
#include "bake/lights/test_lights.h"
#include "bake/receivers/used_vertices.h"

namespace opaline::bake {
namespace {

// Leaves about kMostExpensivePilotReceivers of the receivers whose truth is expensive, evenly
// spread; of the others as many in proportion as without, so that the error of all is that of the
// scene.
void thin_out(const PilotScene& pilot, std::vector<PilotReceiver>& receivers) {
    const auto expensive = static_cast<std::size_t>(
        std::count_if(receivers.begin(), receivers.end(), [&](const auto& r) {
            return has_expensive_truth(pilot.bake, state_of(pilot.subjects, r.material));
        }));
    const std::size_t step =
        (expensive + kMostExpensivePilotReceivers - 1) / kMostExpensivePilotReceivers;
    if (step > 1) {
        std::size_t kept = 0;
        for (std::size_t i = 0; i < receivers.size(); i += step) {
            receivers[kept++] = std::move(receivers[i]);
        }
        receivers.resize(kept);
    }
}

double square_error(std::span<const CheckedPair> pairs) {
    const double rms = relative_rms(pairs);
    return rms * rms;
}

// Pairs of the lights without suns alone.
std::vector<CheckedPair> without_suns(std::span<const CheckedPair> pairs,
                                      std::span<const TestLight> lights) {
    std::vector<CheckedPair> smooth;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        if (lights[i % lights.size()].discs.empty()) {
            smooth.push_back(pairs[i]);
        }
    }
    return smooth;
}

// Everything needed to try a knob. The setting is `choice.knobs`, gathered receiver by receiver.
struct Trials {
    const PilotScene& pilot;
    std::span<const PilotReceiver> receivers;  ///< all
    const FixedPairs& fixed;
    double target;
    PilotChoice choice;
    std::vector<PilotReceiver> tried;  ///< those whose rows depend on trials
    PilotRows rows;

    Trials(const PilotScene& scene, std::span<const PilotReceiver> all, const FixedPairs& known,
           Knobs finest)
        : pilot(scene),
          receivers(all),
          fixed(known),
          target(finest.numerical_target()),
          choice{.knobs = std::move(finest)},
          tried(select_receivers(scene, all, true)),
          rows(scene, tried, choice.knobs) {}

    std::vector<std::vector<CheckedPair>> measure(std::span<const Encoding> encodings) const {
        auto pairs = rows.measure(encodings);
        for (std::size_t e = 0; e < encodings.size(); ++e) {
            pairs[e] = insert_fixed(pilot, receivers, pairs[e], fixed, encodings[e]);
        }
        return pairs;
    }
    // With all coefficients.
    std::vector<CheckedPair> measure() const { return measure(std::array{kUnencoded}).front(); }

    // Takes the coarsest level of a ladder whose square of the error stays below `allowed`.
    void climb(std::size_t effect, const PilotLadder& ladder, double allowed) {
        const Knobs finest = choice.knobs;
        for (const auto& level : ladder.levels) {
            choice.knobs = finest;
            for (const auto& [knob, value] : level) {
                choice.knobs.set(*knob, value);
            }
            choice.knobs = settle(choice.knobs);
            rows.prepare(effect);
            const double square = square_error(measure());
            choice.trials.push_back({std::string(ladder.knob->name), choice.knobs[*ladder.knob],
                                     std::sqrt(square), 16});
            if (square <= allowed) return;
        }
        choice.knobs = finest;
        rows.prepare(effect);
    }

    void choose_coefficients() {
        const Knobs& knobs = choice.knobs;
        const std::vector<Encoding> encodings = list_encodings(knobs);
        const auto pairs = measure(encodings);
        if (pilot.context.cancelled()) return;
        const std::size_t lights = pilot.lights.size();
        std::vector<ErrorBounds> errors;
        bool is_sure = false;
        for (std::size_t e = 0; e < encodings.size() && !is_sure; ++e) {
            errors.push_back(bound_error(pairs[e], lights, knobs.seed));
            choice.trials.push_back({"coefficients", static_cast<double>(encodings[e].coefficients),
                                     errors[e].rms, encodings[e].code_bits});
            is_sure = sure_error(errors[e]) <= target;
        }
        const std::size_t chosen = choose_encoding(errors, target);
        choice.knobs.coefficients = encodings[chosen].coefficients;
        choice.knobs.code_bits = encodings[chosen].code_bits;
        choice.error = errors[chosen].rms;
        choice.likely = likely_error(errors[chosen]);
        choice.met = choice.likely <= target;
    }
};

// Whether some receiver of the pilot depends on the ladders of the effect.
bool is_tried(const PilotScene& pilot, std::size_t effect) {
    const GatherStep& gather = pilot.bake.effects.effects[effect].gather;
    return std::any_of(pilot.subjects.begin(), pilot.subjects.end(),
                       [&](const SubjectState& subject) {
                           return subject.effects[effect].acts &&
                                  (gather.applies == nullptr || gather.applies(subject.layout));
                       });
}

// The finest of all ladders, where the user does not fix them.
Knobs finest_knobs(const EffectTable& effects, Knobs knobs) {
    for (const EffectDescriptor& effect : effects.effects) {
        for (const PilotLadder& ladder : effect.pilot) {
            for (const auto& [knob, value] : ladder.finest) {
                if (!knobs.is_given(*knob)) {
                    knobs.set(*knob, value);
                }
            }
        }
    }
    return settle(std::move(knobs));
}

// More coefficients are taken only if they lower the error by this ratio.
constexpr double kHardlyMore = 1.05;

// A 95 % interval is four of them wide.
double standard_error(const ErrorBounds& bounds) {
    return 0.25 * (bounds.highest - bounds.lowest);
}

}  // namespace

std::vector<PilotReceiver> find_pilot_truth(const PilotScene& pilot, const Knobs& knobs) {
    const auto& sets = pilot.bake.receivers;
    const std::vector<std::uint32_t> used =
        find_used_vertices(pilot.bake.scene, pilot.bake.facts.slots.view());
    const std::size_t wanted = std::clamp(used.size() / kReceiversPerPilotReceiver,
                                          kLeastPilotReceivers, kMostPilotReceivers);
    std::vector<PilotReceiver> receivers;
    std::map<std::uint32_t, SubjectTruth> truths;
    for (const std::uint32_t d :
         draw_evenly(used.size(), wanted, RandomStage::pilot_receivers, knobs.seed)) {
        const std::uint32_t r = used[d];
        const std::uint32_t material = set_of(sets, r).material;
        if (has_truth(pilot.bake, state_of(pilot.subjects, material))) {
            receivers.push_back({r, material, {}});
        }
    }
    thin_out(pilot, receivers);
    for (const PilotReceiver& r : receivers) {
        if (!truths.contains(r.material)) {
            truths.emplace(
                r.material,
                make_subject_truth(pilot.bake, state_of(pilot.subjects, r.material), knobs,
                                   {knobs.numerical_target()}, pilot.lights, pilot.context));
        }
    }
    std::size_t done = 0;
    for_each_block_in_order(
        receivers.size(), 1, pilot.context,
        [&](Range range) {
            const PilotReceiver& r = receivers[range.begin];
            const ReceiverSet& set = set_of(sets, r.receiver);
            const std::size_t i = r.receiver - set.first;
            std::uint64_t traced = 0;
            return eval_truth(truths.at(r.material), {set.outside[i], set.inside[i], r.receiver},
                              traced);
        },
        [&](Range range, TwoEstimates&& truth) {
            receivers[range.begin].truth = std::move(truth);
            done = range.end;
        });
    receivers.resize(done);
    return receivers;
}

PilotChoice choose_row_knobs(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                             const FixedPairs& fixed, const Knobs& knobs) {
    const auto& effects = pilot.bake.effects.effects;
    Knobs finest = finest_knobs(pilot.bake.effects, knobs);
    finest.exact_rays = true;
    Trials trials(pilot, receivers, fixed, std::move(finest));
    const std::vector<CheckedPair> pairs = trials.measure();
    // Every ladder may add its share of the target's square; the rest is for coefficients, which
    // cost most bytes.
    double allowed = square_error(pairs);
    trials.choice.finest_error = std::sqrt(allowed);
    trials.choice.smooth_error = relative_rms(without_suns(pairs, pilot.lights));
    for (std::size_t e = 0; e < effects.size(); ++e) {
        for (const PilotLadder& ladder : effects[e].pilot) {
            if (!is_tried(pilot, e)) continue;
            allowed += ladder.share * trials.target * trials.target;
            if (!knobs.is_given(*ladder.knob)) {
                trials.climb(e, ladder, allowed);
            }
        }
    }
    trials.choose_coefficients();
    trials.choice.knobs.exact_rays = knobs.exact_rays;
    return std::move(trials.choice);
}

double likely_error(const ErrorBounds& bounds) {
    return bounds.rms + standard_error(bounds);
}

double sure_error(const ErrorBounds& bounds) {
    return bounds.rms + 2 * std::numbers::sqrt2 * standard_error(bounds);
}

std::size_t choose_encoding(std::span<const ErrorBounds> errors, double target) {
    const double surest = sure_error(*std::ranges::min_element(errors, {}, sure_error));
    const double enough = surest <= target ? target : kHardlyMore * surest;
    auto chosen =
        std::ranges::find_if(errors, [&](const auto& b) { return !(sure_error(b) > enough); });
    if (likely_error(*chosen) > target) {
        const auto likely =
            std::ranges::find_if(errors, [&](const auto& b) { return likely_error(b) <= target; });
        chosen = likely != errors.end() ? likely : chosen;
    }
    return static_cast<std::size_t>(chosen - errors.begin());
}

}  // namespace opaline::bake
