#include "bake/check/error_warnings.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace opaline::bake {
namespace {

std::string with_interval(const MeasuredError& error) {
    return error_percent(error.rms_relative) + " (95 %: " + error_percent(error.ci95[0]) + " to " +
           error_percent(error.ci95[1]) + ")";
}

// What lowers the error at receivers, by the effect that errs most.
std::string remedy_at_receivers(const MeasuredError& error) {
    const auto worst = std::max_element(
        error.by_effect.begin(), error.by_effect.end(),
        [](const auto& a, const auto& b) { return a.rms_relative < b.rms_relative; });
    return "choose a finer --quality, or more --coefficients and a finer --cubemap; of the "
           "effects, '" +
           worst->name + "' errs most";
}

const char* remedy_between(RefineChoice::Mode mode, bool is_bounded) {
    if (mode == RefineChoice::Mode::off) {
        return "let --refine add receivers where its light changes, or give it more vertices where "
               "shadows end and where things touch";
    }
    if (is_bounded) {
        return "choose a finer --quality or a larger --max-receivers, so that more receivers are "
               "added";
    }
    return mode == RefineChoice::Mode::edges
               ? "give --refine a shorter edge, so that more receivers are added"
               : "choose a finer --quality or give --refine an edge, so that more receivers are "
                 "added";
}

}  // namespace

std::string error_percent(double share) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g %%", 100 * share);
    return text;
}

double acceptable_error(Quality quality) {
    return quality == Quality::draft ? 0.2 : 0.1;
}

bool meets_target(const ErrorReport& error, const Knobs& knobs) {
    const auto meets = [&](const MeasuredError& part) {
        return std::hypot(knobs.model_error, part.rms_relative) <= knobs.error_target;
    };
    return meets(error.at_receivers) && meets(error.between);
}

std::vector<formats::Diagnostic> describe_measured_error(const formats::Scene& scene,
                                                         const Knobs& knobs,
                                                         const ErrorReport& error,
                                                         bool refinement_is_bounded) {
    std::vector<formats::Diagnostic> warnings;
    const bool asked = knobs.error_target > 0;
    const double limit = asked ? knobs.numerical_target() : acceptable_error(knobs.quality);
    const auto is_above = [&](const MeasuredError& e) {
        return (asked ? e.rms_relative : e.ci95[0]) > limit;
    };
    const std::string more =
        ", more than the " + error_percent(limit) +
        (!asked ? " that pass unnoticed"
         : knobs.model_error > knobs.error_target
             ? " that are asked for where the models err by " + error_percent(knobs.model_error)
         : knobs.model_error > 0
             ? " that the models leave of the " + error_percent(knobs.error_target) + " asked for"
             : " asked for");
    if (!asked && is_above(error.at_receivers)) {
        warnings.push_back(formats::make_warning(
            "", "self-check",
            "the file errs by " + with_interval(error.at_receivers) + " at its vertices" + more,
            remedy_at_receivers(error.at_receivers)));
    }
    if (is_above(error.between)) {
        warnings.push_back(formats::make_warning(
            "", "primitive '" + scene.primitives[error.worst_between].name + "'",
            "the file errs by " + with_interval(error.between) + " between its vertices" + more +
                "; most of that here",
            remedy_between(knobs.refine.mode, refinement_is_bounded)));
    }
    return warnings;
}

std::vector<std::string_view> unmeasured_effects(const EffectTable& effects,
                                                 std::span<const PlanEntry> plan) {
    std::vector<std::string_view> names;
    for (const PlanEntry& entry : entries_of(plan, Subject::Kind::material)) {
        const EffectDescriptor& effect = effects[entry.effect];
        if (entry.on && !effect.help.empty() && effect.gather.add == nullptr &&
            effect.exchange_rays == nullptr &&
            std::find(names.begin(), names.end(), effect.name) == names.end()) {
            names.push_back(effect.name);
        }
    }
    return names;
}

}  // namespace opaline::bake
