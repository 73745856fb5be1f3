#include "bake/effects/multiple/view_terms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/rule_layers.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/effects/multiple/walks/exit_light.h"
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

// Of a half space under even light, seen along the normal: how much darker it is than on average.
// Radiance inside is 1 - sqrt(1 - a) H(c') (Chandrasekhar), a the albedo of the similar isotropic
// medium, H(c') = (1 + 2 c') / (1 + 2 c' sqrt(1 - a)) [Hapke1981]. Light that the boundary reflects
// inside evens that out, the more the brighter it is; on Spot at index 1.3 (RESULTS.md, "Walks") by
// about that radiance itself.
double half_space_view_error(const formats::Medium& medium, double mean) {
    constexpr std::array<double, 3> kLuminance{0.2126, 0.7152, 0.0722};
    const double g = formats::mean_cosine(medium.phase);
    double change = 0, sum = 0;
    const auto bands = bands_of(medium);
    for (std::size_t b = 0; b < bands.size(); ++b) {
        const double scattered = (1 - g) * bands[b].sigma_s;
        if (!(scattered > 0)) {
            continue;
        }
        const double root = std::sqrt(bands[b].sigma_a / (scattered + bands[b].sigma_a));
        const auto radiance = [&](double c) { return 1 - root * (1 + 2 * c) / (1 + 2 * c * root); };
        const double evened = medium.eta == 1 ? 0 : radiance(mean);
        change += kLuminance[b] * (1 - evened) * (radiance(mean) - radiance(1));
        sum += kLuminance[b] * radiance(mean);
    }
    return sum > 0 ? change / sum : 0;
}

}  // namespace

double one_view_error(const formats::Medium& medium, const MaterialFacts& body) {
    // Radiance inside is z + c' in proportion, with c' the cosine and z the extrapolation length,
    // so views that are 1 - m apart differ by (1 - m) / (z + m): less, where they are refracted,
    // and light is reflected inside. Twice that is 0.5 at index 1; random views of closed bodies
    // have 0.47, 0.42 and 0.56 at chords of 7, 3 and 70.
    constexpr double kMost = 0.3;
    const auto eta = static_cast<double>(medium.eta);
    const double mean = make_view_lobe(eta).mean, z = extrapolation_length(eta);
    const double share = 2 * (1 - mean) / (z + mean);
    const double length = transport_mean_free_path(medium);
    const double chord =
        body.is_closed() && body.area > 0 ? 4 * std::abs(body.volume) / body.area : 0;
    const double thin = length > 0 && chord > 0 ? share * length / chord : kMost;
    return std::min(kMost, std::hypot(thin, half_space_view_error(medium, mean)));
}

PlanEntry decide_views(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    const PlanEntry& model = input.earlier.back();
    const PlanEntry& effect = *earlier_entry(input, "multiple");
    const auto given = whole(input.knobs, kViewTerms);
    const double error = one_view_error(medium, input.subject);
    const double allowed = allowed_view_error(input.knobs);
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
    } else if (given == 0 && error <= allowed) {
        entry.reason = "one row for all views errs by some " + percent(error);
    } else if (given == 1) {
        entry.reason = "one row for all views, as --view-terms says";
    } else {
        entry.on = true;
        entry.terms = 4;
        entry.reason = "4 rows: one for all views would err by some " + percent(error);
    }
    entry.model_error =
        model.all_orders && !entry.on && is_known && !input.knobs.separate_terms ? error : 0;
    return entry;
}

}  // namespace opaline::bake
