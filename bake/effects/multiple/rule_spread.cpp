#include "bake/effects/multiple/rule_spread.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/effects/multiple/choose_model.h"
#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/half_space_once.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// The deviation of a body's shape from the half space of the local approximation.
struct Shape {
    double feature;    // [m] over which irradiance varies
    double thickness;  // [m]
    double angle;      // [rad] between facets and the smooth surface
};

// Error of multiple scattering in one band: loss for irradiance that varies over a feature, light
// that passes through the body, and the irradiance deficit of facets.
double spread_of_multiple(const Band& band, double g, double eta, const Shape& shape) {
    const Dipole dipole =
        make_dipole(DipoleKind::classic, (1 - g) * band.sigma_s, band.sigma_a, eta);
    const double escape = 1 - fresnel_moments(eta).external;
    const double wave = 2 * std::numbers::pi / shape.feature, all = dipole_total(dipole);
    return escape * (all - dipole_fourier(dipole, wave) + dipole_tail(dipole, shape.thickness) +
                     0.5 * shape.angle * shape.angle * all);
}

// The same for single scattering. On average light enters at a distance r = sin(theta') / (sigma_t
// (1 + cos(theta'))) from its exit, so irradiance appears shifted by r. A short path sees only its
// own facets, whose cosines differ in proportion to their angle.
double spread_of_one_event(const Band& band, double eta, const Shape& shape) {
    const double sigma_t = band.sigma_s + band.sigma_a;
    if (!(band.sigma_s > 0)) return 0;
    const double sine = std::min(1.0, 1 / eta), cosine = std::sqrt(1 - sine * sine);
    const double shift = sine / (sigma_t * (1 + cosine));
    const double lost = std::min(1.0, 2 * std::numbers::pi * shift / shape.feature);
    return half_space_once(eta) * band.sigma_s / sigma_t *
           (lost + std::exp(-sigma_t * shape.thickness) + shape.angle);
}

PlanEntry decide_spread(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const auto eta = static_cast<double>(medium.eta), g = formats::mean_cosine(medium.phase);
    const MaterialFacts& subject = input.subject;
    // Irradiance varies at most from vertex to vertex. The mean thickness of a body of
    // volume V and area A is 2 V/A; thin parts are taken as a quarter of that.
    const Shape shape{4 * subject.mean_edge,
                      subject.has_thickness() ? 0.5 * subject.volume / subject.area : 0,
                      std::acos(std::clamp(1 - 2 * subject.horizon.behind_facets, -1.0, 1.0))};
    PlanEntry entry;
    entry.on = true;
    if (!(shape.feature > 0)) {
        entry.bound = 1;
        entry.reason = "the surface has no size";
        return entry;
    }
    for (const Band& band : bands_of(medium)) {
        entry.bound = std::max(entry.bound, spread_of_multiple(band, g, eta, shape) +
                                                spread_of_one_event(band, eta, shape));
    }
    entry.bound = std::min(entry.bound, 1.0);
    const auto has_earlier = [&](auto&& is_such) {
        return std::ranges::any_of(input.earlier, is_such);
    };
    if (input.knobs.separate_terms) {
        entry.reason = "multiple and single scattering are asked for apart";
    } else if (subject.varies) {
        entry.bound = 1;
        entry.reason =
            "the medium varies in space: light that leaves where it entered has no one colour";
    } else if (has_earlier([](const PlanEntry& e) { return e.on && e.terms > 1; })) {
        entry.reason = "the rows depend on the view";
    } else if (medium.sigma_s == formats::Rgb{}) {
        entry.reason = "what crosses the body unscattered leaves elsewhere than where it entered";
    } else if (has_earlier([](const PlanEntry& e) { return e.on && e.layered; })) {
        entry.reason = "light goes through other media inside";
    } else if (scatters_in_peak(medium) &&
               has_earlier([](const PlanEntry& e) { return e.on && e.all_orders; })) {
        entry.reason = "light that scatters in a peak leaves by random walks alone";
    } else if (!is_worth(entry.bound, input, entry.forced)) {
        entry.on = false;
        entry.reason = "the medium is so dense that light leaves where it entered";
    } else {
        entry.reason = "light comes out elsewhere than where it entered";
    }
    return entry;
}

constexpr std::array<DecisionRule, 1> kSpreadRules{
    {{"multiple.spread", has_medium, decide_spread,
      [](const PlanEntry& entry, RowLayout& layout) { layout.at_entry = !entry.on; }}}};

}  // namespace

std::span<const DecisionRule> spread_rules() {
    return kSpreadRules;
}

}  // namespace opaline::bake
