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
