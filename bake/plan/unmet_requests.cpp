#include "bake/plan/unmet_requests.h"

#include <algorithm>
#include <string>

#include "bake/plan/plan_rules.h"
#include "bake/plan/row_layout.h"
#include "bake/plan/rules_single.h"

namespace opaline::bake {
namespace {

using formats::Diagnostic;
using formats::make_warning;

bool is_concerned(const formats::Scene& scene, const Knobs& knobs, std::string_view effect) {
    const MaterialFacts unknown;  // whom an effect concerns, its material says
    return std::any_of(
        scene.primitives.begin(), scene.primitives.end(), [&](const formats::Primitive& p) {
            return std::any_of(kPlanRules.begin(), kPlanRules.end(), [&](const PlanRule& rule) {
                return rule.effect == effect &&
                       rule.applies({scene.materials[p.material], unknown, knobs});
            });
        });
}

std::string concerns_nothing(const std::string& effect) {
    return "'" + effect + "' concerns nothing in the scene: no surface has a medium";
}

// Effects that were named, and that no material has.
void describe_effects(const formats::Scene& scene, const Knobs& knobs,
                      const std::vector<PlanEntry>& plan, std::vector<Diagnostic>& warnings) {
    for (const std::string& effect : knobs.effects) {
        const PlanEntry* left_out = nullptr;
        bool is_on = false;
        for (const PlanEntry& entry : plan) {
            if (entry.effect == effect) {
                is_on = is_on || entry.on;
                left_out = &entry;
            }
        }
        if (is_on) {
            continue;
        }
        if (!is_concerned(scene, knobs, effect)) {
            warnings.push_back(make_warning("", "--effects", concerns_nothing(effect),
                                            "describe its medium with --media"));
        } else if (left_out != nullptr) {
            warnings.push_back(make_warning(
                "", "--effects", "'" + effect + "' was left out all the same: " + left_out->reason,
                "`opaline plan` shows its bound; `--effects all` heeds none"));
        }
    }
}

// Options of stages that do not run.
void describe_options(const BakeOptions& options, const std::vector<PlanEntry>& plan,
                      const std::vector<RowLayout>& layouts, std::vector<Diagnostic>& warnings) {
    const auto any = [&](auto has) { return std::any_of(layouts.begin(), layouts.end(), has); };
    const bool sampled = any([](const RowLayout& l) { return l.multiple && !l.local; });
    const bool looked_into = any([](const RowLayout& l) { return l.single_terms > 0 && !l.local; });
    const bool both = any([](const RowLayout& l) { return l.multiple && l.single_terms > 0; });
    const bool expanded =
        std::any_of(plan.begin(), plan.end(), [](const PlanEntry& e) { return e.terms > 0; });
    const struct {
        bool idle;
        const char* option;
        const char* why;
    } requests[] = {
        {options.samples != 0 && !sampled, "--samples", "no medium carries light across itself"},
        {options.tolerance >= 0 && !sampled, "--epsilon", "no medium carries light across itself"},
        {options.depth_samples != 0 && !looked_into, "--depth-samples",
         "no light is looked for that scatters once inside"},
        {options.phase_terms > 1 && !expanded, "--phase-terms",
         "nothing scatters once into some directions more than into others, one term is all"},
        {options.separate_terms && !both, "--separate-terms",
         "no material has both multiple and single scattering"}};
    for (const auto& request : requests) {
        if (request.idle) {
            warnings.push_back(make_warning("", request.option,
                                            std::string("does nothing here: ") + request.why,
                                            "`opaline plan` says what is simulated"));
        }
    }
}

// A phase function with too few terms errs by more than any other knob can make good.
void describe_missing_terms(const formats::Scene& scene, const Knobs& knobs,
                            const std::vector<PlanEntry>& plan, std::vector<Diagnostic>& warnings) {
    for (const PlanEntry& entry : plan) {
        const std::uint32_t needed =
            entry.terms > 0 ? needed_terms(*scene.materials[entry.material].medium, knobs) : 0;
        if (needed > entry.terms) {
            warnings.push_back(make_warning(
                "", entry.subject,
                "--phase-terms " + std::to_string(entry.terms) + " was taken as given; " +
                    (knobs.error_target > 0 ? "--error" : "the quality") + " needs " +
                    std::to_string(needed),
                "leave --phase-terms out, or give --phase-terms " + std::to_string(needed)));
        }
    }
}

}  // namespace

formats::Status check_effects(const formats::Scene& scene, const Knobs& knobs) {
    const auto concerned = [&](const std::string& effect) {
        return is_concerned(scene, knobs, effect);
    };
    if (knobs.effects.empty() || scene.primitives.empty() ||
        std::any_of(knobs.effects.begin(), knobs.effects.end(), concerned)) {
        return formats::ok_status();
    }
    return formats::make_error(formats::ErrorKind::usage, "", "--effects",
                               concerns_nothing(knobs.effects.front()),
                               "describe its medium with --media, or leave --effects out");
}

std::vector<Diagnostic> describe_unmet(const formats::Scene& scene, const BakeOptions& options,
                                       const Knobs& knobs, const std::vector<PlanEntry>& plan) {
    std::vector<Diagnostic> warnings;
    describe_effects(scene, knobs, plan, warnings);
    describe_options(options, plan, layout_rows(scene, plan, knobs), warnings);
    describe_missing_terms(scene, knobs, plan, warnings);
    return warnings;
}

}  // namespace opaline::bake
