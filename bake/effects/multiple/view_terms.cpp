#include "bake/effects/multiple/view_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/walks/exit_light.h"
#include "bake/effects/multiple/walks/view_fit.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// Three rows more cost time and memory. From production on they are taken nearly always, because
// thin parts of a body err by more than the estimate for the whole (walks/README.md, "Views").
double allowed_view_error(const Knobs& knobs) {
    return knobs.error_target > 0                 ? 0.3 * knobs.error_target
           : knobs.quality == Quality::reference  ? 0.005
           : knobs.quality == Quality::production ? 0.005
           : knobs.quality == Quality::preview    ? 0.1
                                                  : 0.2;
}

// Five rows more cost time, memory and noise (walks/README.md, "Views").
double allowed_curvature(const Knobs& knobs) {
    return knobs.error_target > 0                 ? 0.3 * knobs.error_target
           : knobs.quality == Quality::reference  ? 0.005
           : knobs.quality == Quality::production ? 0.01
           : knobs.quality == Quality::preview    ? 0.1
                                                  : 0.2;
}

// Of radiance that depends on the cosine inside alone.
struct ViewErrors {
    double mean = 0;
    double constant = 0;  // by how much it is darker along the normal than at the mean cosine
    double linear = 0;    // RMS of what no line holds
};

template <class Radiance>
ViewErrors view_errors(double eta, const ViewFit& fit, Radiance&& radiance) {
    const auto mean_of = [&](auto&& factor) {
        return mean_over_views(
            eta, [&](double c, double) { return factor(c, radiance(std::max(c, 1e-6))); });
    };
    const double mean = mean_of([](double, double f) { return f; });
    const double slope = mean_of([&](double c, double f) { return f * (c - fit.mean); });
    const double rest = mean_of([&](double c, double f) {
        const double off = f - mean - slope / fit.variance * (c - fit.mean);
        return off * off;
    });
    return {mean, radiance(fit.mean) - radiance(1), std::sqrt(rest)};
}

// Of half spaces under even light, relative to what they show.
ViewErrors half_space_errors(const formats::Medium& medium) {
    constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
    const auto eta = static_cast<double>(medium.eta);
    const ViewFit fit = make_view_fit(eta);
    const double g = formats::mean_cosine(medium.phase);
    ViewErrors errors;
    const auto bands = bands_of(medium);
    for (std::size_t b = 0; b < bands.size(); ++b) {
        const double scattered = (1 - g) * bands[b].sigma_s;
        if (!(scattered > 0)) {
            continue;
        }
        // Radiance inside is 1 - sqrt(1 - a) H(c') (Chandrasekhar), a the albedo of the similar
        // isotropic medium, H(c') = (1 + 2 c') / (1 + 2 c' sqrt(1 - a)) [Hapke1981].
        const double root = std::sqrt(bands[b].sigma_a / (scattered + bands[b].sigma_a));
        const auto radiance = [&](double c) { return 1 - root * (1 + 2 * c) / (1 + 2 * c * root); };
        const ViewErrors own = view_errors(eta, fit, radiance);
        // Light that the boundary reflects inside evens that out, the more the brighter it is; on
        // Spot at index 1.3 (RESULTS.md, "Walks") by about that radiance itself.
        const double left = medium.eta == 1 ? 1 : 1 - radiance(fit.mean);
        // Forward scattering bends it more than isotropic events of the same transport do: fitted
        // to half spaces of g = 0 to .9 and albedos of .1 to .99 by doubling, within 40 %.
        const double peak = 1 + 2.5 * std::sqrt(std::max(g, 0.0) / (1 - g)) * root * root;
        errors.constant += kLuminance[b] * left * own.constant;
        errors.linear += kLuminance[b] * left * own.linear * peak;
        errors.mean += kLuminance[b] * own.mean;
    }
    if (errors.mean > 0) {
        errors.constant /= errors.mean;
        errors.linear /= errors.mean;
    }
    return errors;
}

// In transport mean free paths; infinite where it is not known or nothing scatters.
double mean_chord(const formats::Medium& medium, const MaterialFacts& body) {
    const double length = transport_mean_free_path(medium);
    const double chord =
        body.is_closed() && body.area > 0 ? 4 * std::abs(body.volume) / body.area : 0;
    return length > 0 && chord > 0 ? chord / length : HUGE_VAL;
}

}  // namespace

double one_view_error(const formats::Medium& medium, const MaterialFacts& body) {
    // Radiance inside is z + c' in proportion, with c' the cosine and z the extrapolation length,
    // so views that are 1 - m apart differ by (1 - m) / (z + m): less, where they are refracted,
    // and light is reflected inside. Twice that is 0.5 at index 1; random views of closed bodies
    // have 0.47, 0.42 and 0.56 at chords of 7, 3 and 70.
    constexpr double kMost = 0.3;
    const auto eta = static_cast<double>(medium.eta);
    const double mean = make_view_fit(eta).mean, z = extrapolation_length(eta);
    const double share = 2 * (1 - mean) / (z + mean);
    const double chord = mean_chord(medium, body);
    const double thin = std::isfinite(chord) ? share / chord : kMost;
    return std::min(kMost, std::hypot(thin, half_space_errors(medium).constant));
}

double four_views_error(const formats::Medium& medium, const MaterialFacts& body) {
    // A slab under even light that absorbs nothing shows 1 - e^(-x / c'), with x its thickness in
    // mean free paths, half its mean chord.
    const auto eta = static_cast<double>(medium.eta);
    const double x = 0.5 * mean_chord(medium, body);
    double thin = 0;
    if (std::isfinite(x)) {
        const ViewErrors slab =
            view_errors(eta, make_view_fit(eta), [x](double c) { return -std::expm1(-x / c); });
        thin = slab.linear / slab.mean;
    }
    return std::hypot(thin, half_space_errors(medium).linear);
}

PlanEntry decide_views(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PlanEntry& model = input.earlier.back();
    const PlanEntry& effect = input.earlier[input.earlier.size() - 2];
    const auto given = whole(input.knobs, kViewTerms);
    const double error = one_view_error(medium, input.subject);
    const double curved = four_views_error(medium, input.subject);
    const double allowed = allowed_view_error(input.knobs);
    const std::uint32_t wanted = given > 1                                 ? given
                                 : curved > allowed_curvature(input.knobs) ? 9
                                                                           : 4;
    const bool is_known = input.subject.has_thickness() || measures_models(input.knobs);
    PlanEntry entry;
    entry.alternative = true;
    entry.least_terms = 4;
    entry.terms = 1;
    entry.bound = effect.on ? error * effect.bound : 0;
    if (!model.all_orders) {
        entry.reason = effect.on && model.on ? "one row for all views: as the dipole has it"
                                             : "one row for all views: no random walks";
    } else if (input.knobs.separate_terms) {
        entry.reason = "one row for all views stands apart, as --separate-terms says";
    } else if (given == 0 && !is_known) {
        entry.reason = "one row for all views: how thick the open body is, is not known";
    } else if (given == 0 && error <= allowed && wanted == 4) {
        entry.reason = "one row for all views errs by some " + percent(error);
    } else if (given == 1) {
        entry.reason = "one row for all views, as --view-terms says";
    } else {
        entry.on = true;
        entry.terms = wanted;
        entry.reason =
            std::to_string(wanted) + " rows: " +
            (wanted == 9 ? "four, linear in the view, would err by some " + percent(curved)
                         : "one for all views would err by some " + percent(error));
    }
    if (model.all_orders && is_known && !input.knobs.separate_terms) {
        entry.model_error = !entry.on ? error : entry.terms == 4 ? curved : 0;
    }
    return entry;
}

}  // namespace opaline::bake
