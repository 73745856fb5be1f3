#include "bake/effects/multiple/view_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/walks/exit_lobe.h"
#include "bake/effects/multiple/walks/view_fit.h"
#include "bake/effects/multiple/walks/walk_space.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

// Three more rows cost time and memory. From production on nearly all bodies have them, because
// thin parts of a body err by more than the estimate for the whole (walks/README.md, "Views").
double allowed_view_error(const Knobs& knobs) {
    return allowed_error(knobs, 0.3, {0.2, 0.05, 0.005, 0.005});
}

// Five rows more cost time, memory and noise (walks/README.md, "Views").
double allowed_curvature(const Knobs& knobs) {
    return allowed_error(knobs, 0.3, {0.2, 0.1, 0.03, 0.01});
}

// 1 - sqrt(1 - a) H(c') (Chandrasekhar) is the radiance inside a half space under even light, a the
// albedo of the similar isotropic medium, H(c') = (1 + 2 c') / (1 + 2 c' sqrt(1 - a)) [Hapke1981].
struct HalfSpace {
    double root = 0;    // sqrt(1 - a)
    double peak = 1;    // by how much more forward scattering bends it
    double weight = 0;  // of the band in luminance

    double radiance(double c) const { return 1 - root * (1 + 2 * c) / (1 + 2 * c * root); }
    // Light that the boundary reflects inside evens its views out, the more the brighter it is; on
    // Spot at index 1.3 (RESULTS.md, "Walks") by about that radiance itself.
    double left(const formats::Medium& medium, double mean) const {
        return medium.eta == 1 ? 1 : 1 - radiance(mean);
    }
};

// Of bands that scatter.
std::vector<HalfSpace> half_spaces(const formats::Medium& medium) {
    constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
    const double g = formats::mean_cosine(medium.phase);
    std::vector<HalfSpace> spaces;
    const auto bands = bands_of(medium);
    for (std::size_t b = 0; b < bands.size(); ++b) {
        const double scattered = (1 - g) * bands[b].sigma_s;
        if (scattered > 0) {
            // The peak: fitted to half spaces of g = 0 to .9 and albedos of .1 to .99 by doubling,
            // within 40 %. Behind a boundary that refracts, nine rows showed no gain (RESULTS.md).
            const double square = bands[b].sigma_a / (scattered + bands[b].sigma_a);
            const double peak =
                medium.eta == 1 ? 1 + 2.5 * std::sqrt(std::max(g, 0.0) / (1 - g)) * square : 1;
            spaces.push_back({std::sqrt(square), peak, kLuminance[b]});
        }
    }
    return spaces;
}

// How much darker half spaces are along the normal than on average.
double half_space_view_error(const formats::Medium& medium, double mean) {
    double change = 0, sum = 0;
    for (const HalfSpace& space : half_spaces(medium)) {
        const double average = space.radiance(mean);
        change += space.weight * space.left(medium, mean) * (average - space.radiance(1));
        sum += space.weight * average;
    }
    return sum > 0 ? change / sum : 0;
}

// Of a function of the cosine inside: the RMS of its part of degree two over its mean, with the
// sign of that part along the normal.
template <class Radiance>
double curvature(double eta, const ViewFit& fit, Radiance&& radiance) {
    const double part = mean_over_views(
        eta, [&](double c, double) { return radiance(std::max(c, 1e-6)) * bend_of(fit, c); });
    const double mean =
        mean_over_views(eta, [&](double c, double) { return radiance(std::max(c, 1e-6)); });
    return mean > 0 ? part / std::sqrt(fit.bend) / mean : 0;
}

// In transport mean free paths; infinite where it is not known or nothing scatters.
double mean_chord(const formats::Medium& medium, const MaterialFacts& body) {
    const double length = transport_mean_free_path(medium);
    const double chord = body.has_thickness() ? 4 * std::abs(body.volume) / body.area : 0;
    return length > 0 && chord > 0 ? chord / length : HUGE_VAL;
}

// Of bodies whose thickness is not known: as thin as a line over the view errs most by.
constexpr double kThinChord = 2;

// 36 pi V^2 / S^3: 1 of a ball, 0.08 of a square plate ten times as wide as thick.
bool is_flat(const MaterialFacts& body) {
    constexpr double kPlate = 0.08;
    return body.has_thickness() && 36 * std::numbers::pi * body.volume * body.volume <
                                       kPlate * body.area * body.area * body.area;
}

std::uint32_t rows_for(double curved, const Knobs& knobs) {
    return curved > allowed_curvature(knobs) ? 9 : 4;
}

// `one`, `four`: what so many rows err by.
void take_views(double one, double four, std::uint32_t rows, PlanEntry& entry) {
    entry.on = true;
    entry.terms = rows;
    entry.reason = std::to_string(rows) + " rows: " +
                   (rows == 9 ? "four, linear in the view, would err by some " + percent(four)
                              : "one for all views would err by some " + percent(one));
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
    return std::min(kMost, std::hypot(thin, half_space_view_error(medium, mean)));
}

double four_views_error(const formats::Medium& medium, const MaterialFacts& body) {
    const auto eta = static_cast<double>(medium.eta);
    const ViewFit fit = make_view_fit(eta);
    const bool is_known = std::isfinite(mean_chord(medium, body));
    const double chord = is_known ? mean_chord(medium, body) : kThinChord;
    double flat = 0, round = 0, sum = 0;
    for (const HalfSpace& space : half_spaces(medium)) {
        const auto half = [&](double c) { return space.radiance(c); };
        const double all = curvature(eta, fit, half),
                     own = space.left(medium, fit.mean) * space.peak * all;
        // A ball shows less toward its edge, where the way through it, 3/2 of the mean chord along
        // the normal, is short.
        const auto ball = [&](double c) { return -half(c) * std::expm1(-1.5 * chord * c); };
        flat += space.weight * own;
        round += space.weight * (own + curvature(eta, fit, ball) - all);
        sum += space.weight;
    }
    if (!(sum > 0)) return 0;
    // A slab that absorbs nothing shows 1 - e^(-x / c') under even light, x its thickness in mean
    // free paths. Lit from one side it bends by more, within 20 % of doubling at x = .5 to 5 and
    // index 1.
    const double x = 0.5 * chord, narrow = std::sqrt(fit.bend / make_view_fit(1).bend);
    const double slab = curvature(eta, fit, [x](double c) { return -std::expm1(-x / c); });
    const double plate = std::hypot(flat / sum, slab, 0.12 * narrow * x * std::exp(-x));
    return is_known && !is_flat(body) ? std::min(plate, std::abs(round / sum)) : plate;
}

PlanEntry decide_views(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PlanEntry& model = input.earlier.back();
    const PlanEntry& effect = *earlier_entry(input, "multiple");
    const auto given = whole(input.knobs, kViewTerms);
    const double error = one_view_error(medium, input.subject);
    const double curved = four_views_error(medium, input.subject);
    const double allowed = allowed_view_error(input.knobs);
    const std::uint32_t wanted = given > 1 ? given : rows_for(curved, input.knobs);
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
        take_views(error, curved, wanted, entry);
    }
    if (model.all_orders && is_known && !input.knobs.separate_terms) {
        entry.model_error = !entry.on ? error : entry.terms == 4 ? curved : 0;
    }
    return entry;
}

bool measures_views(const Knobs& knobs) {
    return (knobs.error_target > 0 || knobs.quality >= Quality::preview) &&
           whole(knobs, kViewTerms) == 0 && !knobs.separate_terms;
}

void amend_views(const ModelError& measured, const PlanInput& input, PlanEntry& entry) {
    if (measured.receivers == 0) return;
    const MaterialFacts& body = input.subject;
    const bool is_known = body.has_thickness();
    const double one =
        std::max(measured.error, is_known ? one_view_error(*input.material.medium, body) : 0.0);
    // What four leave is too small a difference to be measured so.
    const double four = is_known ? four_views_error(*input.material.medium, body) : 0;
    const std::uint32_t rows = rows_for(four, input.knobs);
    if (one > allowed_view_error(input.knobs) || rows == 9) {
        take_views(one, four, rows, entry);
    } else {
        entry.on = false;
        entry.terms = 1;
        entry.reason = "one row for all views errs by some " + percent(one);
    }
    entry.reason += ", measured at " + std::to_string(measured.receivers) + " vertices";
    entry.model_error = !entry.on ? one : entry.terms == 4 ? four : 0;
}

}  // namespace opaline::bake
