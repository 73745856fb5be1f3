#include "bake/effects/multiple/rule_multiple.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/multiple_costs.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/physics/half_space_once.h"
#include "bake/plan/plan_input.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

using formats::Medium;

// Profiles with a finite centre in closed form.
bool is_dipole(const Medium& medium) {
    return medium.fidelity == Medium::Fidelity::physical &&
           medium.profile != Medium::Profile::beams &&
           medium.profile != Medium::Profile::normalized;
}

double half_space_bound(const Medium& medium, const Band& band) {
    const double g = formats::mean_cosine(medium.phase);
    // Light can enter a thin body from both sides. With a strongly forward phase function (g >=
    // 0.98, index 1) one side of the baked result is up to 1.9 times the classic total.
    return 2 * dipole_total(make_dipole(DipoleKind::classic, (1 - g) * band.sigma_s, band.sigma_a,
                                        static_cast<double>(medium.eta)));
}

// Bound on the share of light along a line of length `diagonal` [m] that scatters once.
double once_bound(const Band& band, double diagonal) {
    const double sigma_t = band.sigma_s + band.sigma_a;
    return sigma_t > 0 ? band.sigma_s / sigma_t * -std::expm1(-sigma_t * diagonal) : 0;
}

// kappa / sigma_t of isotropic scattering: alpha / (2 k) ln((1 + k) / (1 - k)) = 1, by bisection.
double diffusion_exponent(double albedo) {
    double low = 0, high = 1;
    for (int i = 0; i < 60; ++i) {
        const double k = 0.5 * (low + high);
        (albedo * std::atanh(k) < k ? low : high) = k;
    }
    return low;
}

bool scatters_nothing(const Medium& medium) {
    return std::ranges::all_of(bands_of(medium), [](const Band& b) { return !(b.sigma_s > 0); });
}

double reaches(const Band& band, double g, double eta, double depth) {
    const double straight = std::exp(-band.sigma_a * depth);
    const double reduced = (1 - g) * band.sigma_s, sigma_t = reduced + band.sigma_a;
    if (!(reduced > 0) || !(band.sigma_a > 0)) return straight;
    const double albedo = reduced / sigma_t, k = diffusion_exponent(albedo);
    const double far = k * sigma_t * depth;
    // x / sinh(x) without overflow; 1 at 0.
    const double decay = far > 0 ? 2 * far * std::exp(-far) / -std::expm1(-2 * far) : 1;
    const double stays = 1 - fresnel_moments(eta).diffuse_internal();
    return std::min(straight, (1 + k) / albedo * decay / std::max(stays, 1e-6));
}

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

double small_body_bound(const Medium& medium, const Band& band, double diagonal, double area) {
    if (medium.eta != 1 || !is_dipole(medium)) return HUGE_VAL;
    if (!(band.sigma_s > 0)) return 0;
    const double albedo = band.sigma_s / (band.sigma_s + band.sigma_a);
    const double once = once_bound(band, diagonal);
    const double reduced = (1 - formats::mean_cosine(medium.phase)) * band.sigma_s;
    const auto dipole_of = [&](DipoleKind kind) {
        return make_dipole(kind, reduced, band.sigma_a, 1);
    };
    // The better dipole is scaled to a walk's multiple scattering, which is at most the light that
    // survives two scattering events.
    const Dipole better = dipole_of(DipoleKind::better);
    const double centre = medium.profile == Medium::Profile::classic
                              ? eval_dipole(dipole_of(DipoleKind::classic), 0)
                              : albedo * albedo * eval_dipole(better, 0) / dipole_total(better);
    return std::max(once * once, centre * area);
}

PlanEntry decide_multiple(const PlanInput& input) {
    const Medium& medium = *input.material.medium;
    const double diagonal =
        static_cast<double>(glm::length(input.subject.high - input.subject.low));
    PlanEntry entry;
    entry.has_bands = true;
    double of_half_space = 0;
    for (const Band& band : bands_of(medium)) {
        const double half_space = half_space_bound(medium, band);
        of_half_space = std::max(of_half_space, half_space);
        entry.bound = std::max(
            entry.bound,
            std::min(half_space, small_body_bound(medium, band, diagonal, input.subject.area)));
        if (input.subject.varies) {
            // Walks of a medium that varies carry light that scatters once as well.
            entry.bound = std::max(entry.bound, once_bound(band, diagonal));
        }
    }
    // What goes through media inside is at most the light that reaches them.
    entry.bound =
        std::min(std::max(entry.bound, 1.0), entry.bound + layer_bound(medium, input.subject));
    entry.bound = input.subject.is_buried ? 0 : entry.bound;
    if (!is_wanted(input.knobs, "multiple")) {
        entry.reason = "left out by --effects";
        return entry;
    }
    entry.on = is_worth(entry.bound, input, entry.forced);
    if (!entry.on) {
        entry.reason = input.subject.is_buried
                           ? "its surface lies inside other media and is not seen"
                       : entry.bound < of_half_space
                           ? "the body is so small that light hardly scatters twice in it"
                           : "the medium absorbs nearly all that it scatters";
        return entry;
    }
    const double samples =
        expected_samples(medium, input.subject.area, input.subject.receivers, input.knobs);
    entry.reason = "light scatters many times inside; " +
                   std::to_string(static_cast<std::uint64_t>(samples)) + " surface samples";
    return entry;
}

double share_that_reaches(const formats::Medium& medium, double depth) {
    double most = 0;
    for (const Band& band : bands_of(medium)) {
        most = std::max(most, reaches(band, formats::mean_cosine(medium.phase),
                                      static_cast<double>(medium.eta), depth));
    }
    return most;
}

double layer_bound(const formats::Medium& medium, const MaterialFacts& body) {
    double nearest = HUGE_VAL;
    // What crosses clear bodies alone is the light of `transmission`.
    const bool is_clear = scatters_nothing(medium);
    for (const InnerMedium& inner : body.inner) {
        if (!is_same_medium(medium, inner.medium) &&
            !(is_clear && scatters_nothing(inner.medium))) {
            nearest = std::min(nearest, inner.depth);
        }
    }
    return std::isfinite(nearest) ? share_that_reaches(medium, nearest) : 0;
}

bool has_inner_media(const PlanInput& input) {
    return input.material.medium && !input.subject.inner.empty();
}

PlanEntry decide_layers(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    entry.alternative = entry.layered = true;
    entry.bound = layer_bound(medium, input.subject);
    if (!earlier_entry(input, "multiple")->on) {
        entry.reason = "no light that scatters inside is simulated";
    } else if (std::ranges::all_of(input.subject.inner, [&](const InnerMedium& inner) {
                   return is_same_medium(medium, inner.medium);
               })) {
        entry.reason = "the media inside are the same as its own";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        entry.reason = "the media inside lie so deep that hardly any light reaches them";
    } else {
        entry.reason = "light goes through other media inside";
    }
    return entry;
}

const PlanEntry* earlier_entry(const PlanInput& input, std::string_view name) {
    const auto found = std::ranges::find_if(
        input.earlier, [name](const PlanEntry& entry) { return entry.name == name; });
    return found == input.earlier.end() ? nullptr : &*found;
}

std::vector<std::uint32_t> inner_materials(const EffectInputs& inputs) {
    std::vector<std::uint32_t> materials;
    for (const InnerMedium& inner : inputs.bake.facts.material[inputs.material].inner) {
        materials.push_back(inner.material);
    }
    return materials;
}

bool meets_others(const EffectInputs& inputs) {
    return std::ranges::any_of(inputs.bake.facts.material[inputs.material].inner,
                               [](const InnerMedium& inner) { return inner.depth == 0; });
}

void warn_of_layers(const EffectInputs& inputs, std::vector<formats::Diagnostic>& warnings) {
    const formats::Scene& scene = inputs.bake.scene;
    std::string names;
    for (const InnerMedium& inner : inputs.bake.facts.material[inputs.material].inner) {
        names += (names.empty() ? "'" : ", '") + scene.materials[inner.material].name + "'";
    }
    warnings.push_back(formats::make_warning(
        "", "material '" + scene.materials[inputs.material].name + "'",
        "other media lie inside (" + names + "), but the model takes the body for one medium alone",
        "bake with --multiple-model auto or walks, which pass through them"));
}

std::span<const DecisionRule> spread_rules() {
    return kSpreadRules;
}

}  // namespace opaline::bake
