#include "bake/pipeline/unmet_requests.h"

#include <algorithm>
#include <string>
#include <utility>

#include "bake/check/error_warnings.h"

#include "bake/scene/base_color.h"

namespace opaline::bake {
namespace {

using formats::Diagnostic;
using formats::make_warning;

bool sends_out_light(const formats::Scene& scene) {
    return !scene.lights.empty() || std::ranges::any_of(scene.materials, is_emissive);
}

bool is_concerned(const EffectTable& effects, const formats::Scene& scene, const Knobs& knobs,
                  std::string_view name) {
    const auto found = std::ranges::find(effects.effects, name, &EffectDescriptor::name);
    if (found == effects.effects.end()) return false;
    switch (found->kind) {
        case Subject::Kind::volume:
            return !scene.volumes.empty();
        case Subject::Kind::layer:
            return !scene.layers.empty();
        case Subject::Kind::emitter:
            return sends_out_light(scene);
        case Subject::Kind::material:
            break;
    }
    const MaterialFacts unknown;  // placeholder: concerns() reads the material only
    return !found->rules.empty() &&
           std::ranges::any_of(scene.primitives, [&](const formats::Primitive& p) {
               return found->rules.front().concerns({scene.materials[p.material], unknown, knobs});
           });
}

std::string concerns_nothing(const std::string& effect) {
    return "'" + effect +
           "' concerns nothing in the scene: no material, volume, layer or light is of its kind";
}

// Effects that were named, and that no subject has.
void describe_effects(const DecidedBake& decided, std::vector<Diagnostic>& warnings) {
    for (const std::string& effect : decided.knobs.effects) {
        const PlanEntry* left_out = nullptr;
        bool is_on = false;
        for (const PlanEntry& entry : decided.plan) {
            if (entry.name == effect) {
                is_on = is_on || entry.on || entry.all_orders;  // another effect has its light
                left_out = &entry;
            }
        }
        if (is_on) continue;
        if (!is_concerned(decided.effects, decided.scene, decided.knobs, effect)) {
            warnings.push_back(make_warning(
                "", "--effects", concerns_nothing(effect),
                "`opaline plan` shows what does; media and thin-walled surfaces may be "
                "described with --media"));
        } else if (left_out != nullptr) {
            warnings.push_back(make_warning(
                "", "--effects", "'" + effect + "' was left out all the same: " + left_out->reason,
                "`opaline plan` shows its bound; `--effects all` heeds none"));
        }
    }
}

// Options of stages that do not run.
void describe_options(const DecidedBake& decided, const BakeOptions& options,
                      std::vector<Diagnostic>& warnings) {
    const std::vector<RowLayout> layouts =
        layout_rows(decided.effects, decided.scene, decided.plan, decided.knobs);
    const auto matters = [&](const KnobSpec& knob) {
        for (std::uint32_t m = 0; m < layouts.size(); ++m) {
            if (knob.matters(layouts[m], entries_of(decided.plan, m))) return true;
        }
        return knob.matters({}, decided.plan);
    };
    std::string idle;
    const auto list = [&](std::string_view option) {
        idle.append(idle.empty() ? "" : ", ").append(option);
    };
    for (const auto& [knob, value] : options.given.values) {
        // The least that an `auto` knob may be is what idle subjects get anyway.
        const bool is_least = knob->zero_is_auto && value <= knob->lowest;
        if (knob->matters != nullptr && !is_least && !matters(*knob)) {
            list(knob->option);
        }
    }
    const auto has_both = [](const RowLayout& l) {
        return l.translucent && l.constant && l.harmonics > 0;
    };
    if (options.separate_terms && std::none_of(layouts.begin(), layouts.end(), has_both)) {
        list("--separate-terms");
    }
    if (!idle.empty()) {
        warnings.push_back(make_warning("", "", "not used here: " + idle,
                                        "`opaline plan` says what is simulated"));
    }
}

}  // namespace

formats::Status check_effects(const EffectTable& effects, const formats::Scene& scene,
                              const Knobs& knobs) {
    const auto concerned = [&](const std::string& effect) {
        return is_concerned(effects, scene, knobs, effect);
    };
    if (knobs.effects.empty() || scene.primitives.empty() ||
        std::any_of(knobs.effects.begin(), knobs.effects.end(), concerned)) {
        return formats::ok_status();
    }
    return formats::make_error(
        formats::ErrorKind::usage, "", "--effects", concerns_nothing(knobs.effects.front()),
        "describe media and thin-walled surfaces with --media, or leave --effects out");
}

std::optional<Diagnostic> describe_missed_models(double target, double model) {
    if (!(target > 0) || model < target) return std::nullopt;
    return make_warning(
        "", "--error",
        error_percent(target) + " is out of reach: the models err by " + error_percent(model),
        "allow a larger error, or leave out the option that chose; `opaline plan` says which "
        "decision errs");
}

std::vector<Diagnostic> describe_early(const DecidedBake& decided) {
    std::vector<Diagnostic> warnings;
    if (auto missed =
            describe_missed_models(decided.knobs.error_target, find_model_error(decided.plan))) {
        warnings.push_back(std::move(*missed));
    }
    for (const PlanEntry& entry : entries_of(decided.plan, Subject::Kind::material)) {
        const DecisionRule& rule = rule_of(decided.effects, entry);
        const std::uint32_t m = entry.subject.index;
        if (rule.warn != nullptr) {
            rule.warn({decided.scene.materials[m], decided.facts.material[m], decided.knobs}, entry,
                      warnings);
        }
    }
    return warnings;
}

std::vector<Diagnostic> describe_unmet(const DecidedBake& decided, const BakeOptions& options) {
    std::vector<Diagnostic> warnings;
    describe_effects(decided, warnings);
    describe_options(decided, options, warnings);
    for (Diagnostic& early : describe_early(decided)) {
        warnings.push_back(std::move(early));
    }
    return warnings;
}

}  // namespace opaline::bake
