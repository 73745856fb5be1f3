#include "bake/effects/multiple/rule_multiple.h"

#include <algorithm>
#include <cmath>

#include "bake/effects/multiple/multiple_costs.h"
#include "bake/effects/multiple/rule_layers.h"
#include "bake/scattering/dipole.h"
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

}  // namespace

double small_body_bound(const Medium& medium, const Band& band, double diagonal, double area) {
    if (medium.eta != 1 || !is_dipole(medium)) {
        return HUGE_VAL;
    }
    if (!(band.sigma_s > 0)) {
        return 0;
    }
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
    const double samples = expected_samples(medium, input.subject.area, input.knobs);
    entry.reason = "light scatters many times inside; " +
                   std::to_string(static_cast<std::uint64_t>(samples)) + " surface samples";
    return entry;
}

}  // namespace opaline::bake
