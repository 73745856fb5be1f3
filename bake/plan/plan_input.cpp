#include "bake/plan/plan_input.h"

#include <algorithm>

namespace opaline::bake {

bool is_named(const Knobs& knobs, std::string_view effect) {
    return std::find(knobs.effects.begin(), knobs.effects.end(), effect) != knobs.effects.end();
}

bool is_wanted(const Knobs& knobs, std::string_view effect) {
    return knobs.effects.empty() || is_named(knobs, effect);
}

std::array<Band, 3> bands_of(const formats::Medium& medium) {
    const auto band = [](float s, float a) {
        return Band{static_cast<double>(s), static_cast<double>(a)};
    };
    return {band(medium.sigma_s.r, medium.sigma_a.r), band(medium.sigma_s.g, medium.sigma_a.g),
            band(medium.sigma_s.b, medium.sigma_a.b)};
}

bool is_worth(double bound, const PlanInput& input, bool& forced) {
    const bool worth = !(bound < input.least_bound);
    forced = input.knobs.simulate_all && !worth;
    return worth || forced;
}

double least_bound(const Knobs& knobs, std::size_t decisions) {
    constexpr double kShareOfError = 0.25;
    return knobs.error_target > 0
               ? std::min(kLeastBound, kShareOfError * knobs.error_target /
                                           static_cast<double>(std::max<std::size_t>(1, decisions)))
               : kLeastBound;
}

PlanEntry decide_by_bound(std::string_view name, const Subject& subject, double bound,
                          std::size_t decisions, const Knobs& knobs) {
    PlanEntry entry;
    entry.name = name;
    entry.subject = subject;
    entry.bound = bound;
    if (!is_wanted(knobs, name.substr(0, name.find('.')))) {
        entry.reason = "left out by --effects";
        return entry;
    }
    entry.on = !(bound < least_bound(knobs, decisions));
    if (!entry.on && knobs.simulate_all && bound > 0) entry.on = entry.forced = true;
    return entry;
}

void explain(PlanEntry& entry, const std::string& on, const std::string& off) {
    if (entry.reason.empty()) entry.reason = entry.on ? on : off;
}

void tell_forced(PlanEntry& entry) {
    if (entry.forced) entry.reason += "; forced: by its bound it would be left out";
}

bool has_medium(const PlanInput& input) {
    return input.material.medium.has_value();
}

bool is_any_material(const PlanInput&) {
    return true;
}

bool is_thin_walled(const PlanInput& input) {
    return input.material.sheet.has_value();
}

}  // namespace opaline::bake
