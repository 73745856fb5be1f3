#include "bake/effects/multiple/choose_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include "bake/effects/multiple/multiple_costs.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/rule_multiple.h"
#include "bake/effects/multiple/thin_parts.h"
#include "bake/plan/medium_exitance.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

double expected_error(const formats::Medium& medium, const MaterialFacts& body) {
    const double length =
        boundary_reach(static_cast<double>(medium.eta)) * transport_mean_free_path(medium);
    if (!(length > 0)) return 0;
    return half_space_error(body.has_thickness() ? 4 * std::abs(body.volume) / body.area / length
                                                 : 0);
}

// Whether sharp edges, a mean free path wide, are a part of the surface that shows. `single` looks
// along the normal, which runs down the other face there: of even light a cube of 40 mean free
// paths and index 1 shows .81 at its edges, and .90 by walks. The share is found by trial.
bool has_edges(const formats::Medium& medium, const MaterialFacts& body) {
    constexpr double kShows = 0.02;
    return body.sharp_edges * transport_mean_free_path(medium) > kShows * body.area;
}

// Whether walks also carry light that scatters once. Residual sites are so far apart that they blur
// it. Under a peaked phase function terms in the view err by more than that
// (tests/bench/RESULTS.md, "Walks"), at edges `single` does, and no other model simulates media
// that vary.
bool hold_all_orders(const formats::Medium& medium, const MaterialFacts& body, const Knobs& knobs) {
    return transport_mean_free_path(medium) > 0 && body.area > 0 &&
           (body.varies || !expected_sites(medium, body, knobs).is_residual ||
            scatters_in_peak(medium) || has_edges(medium, body));
}

// Error of the dipole in media with a forward peak: light scattered once is expanded in at most 25
// terms of the view.
double peak_error(const formats::Medium& medium) {
    constexpr unsigned kMostTerms = 25;
    return scatters_in_peak(medium) ? once_error(medium, kMostTerms) : 0;
}

// Error of walks where light leaves in such a peak (tests/bench/RESULTS.md, "Sites inside").
constexpr double kWalksErrInPeak = 0.15;

bool is_too_peaked(const formats::Medium& medium, const Knobs& knobs) {
    return peak_error(medium) > std::max(kWalksErrInPeak, allowed_model_error(knobs));
}

// Of walks that follow light scattered once.
double walks_error(const formats::Medium& medium) {
    return peak_error(medium) > kWalksErrInPeak ? kWalksErrInPeak : 0;
}

// A profile that the user chose is meant.
bool is_fixed(const formats::Medium& medium) {
    return medium.profile != formats::Medium::Profile::automatic ||
           medium.fidelity == formats::Medium::Fidelity::paper;
}

}  // namespace

std::string percent(double error) {
    const std::string text = std::to_string(1e-1 * std::round(1e3 * error));
    return text.substr(0, text.find('.') + 2) + " %";
}

bool scatters_in_peak(const formats::Medium& medium) {
    constexpr double kPeaked = 0.5;
    return std::abs(formats::mean_cosine(medium.phase)) >= kPeaked;
}

double allowed_error(const Knobs& knobs, double share, const std::array<double, 4>& by_quality) {
    return knobs.error_target > 0 ? share * knobs.error_target
                                  : by_quality[static_cast<std::size_t>(knobs.quality)];
}

double allowed_model_error(const Knobs& knobs) {
    return allowed_error(knobs, std::numbers::sqrt2 / 2, {0.1, 0.05, 0.02, 0.005});
}

// A measurement costs about as much as a bake at draft.
bool measures_models(const Knobs& knobs) {
    return knobs.error_target > 0 || knobs.quality >= Quality::production;
}

bool expects_walks(const formats::Medium& medium, const MaterialFacts& body, bool layered,
                   const Knobs& knobs) {
    const auto asked = static_cast<MultipleModel>(whole(knobs, kMultipleModel));
    return asked == MultipleModel::automatic
               ? body.varies || (!is_fixed(medium) &&
                                 (layered || body.overlaps || is_too_peaked(medium, knobs) ||
                                  expected_error(medium, body) > allowed_model_error(knobs)))
               : asked != MultipleModel::dipole;
}

ModelChoice choose_model(const EffectInputs& inputs, const MediumProfile& profile,
                         std::uint64_t& traced) {
    const auto asked = static_cast<MultipleModel>(whole(inputs.knobs, kMultipleModel));
    const MaterialFacts& body = inputs.bake.facts.material[inputs.material];
    const bool is_auto = asked == MultipleModel::automatic;
    const bool layered = inputs.layout.layered;
    const bool may_hold = layered || hold_all_orders(inputs.medium(), body, inputs.knobs);
    const double allowed = allowed_model_error(inputs.knobs);
    ModelChoice choice;
    choice.model = is_auto ? MultipleModel::dipole : asked;
    choice.all_orders = may_hold && !inputs.layout.at_entry;
    choice.dipole_error = expected_error(inputs.medium(), body);
    choice.walks_error = choice.all_orders ? walks_error(inputs.medium()) : 0;
    // A peaked medium may not scatter at entry alone once single scattering has terms of its own.
    const bool may_walk = is_auto && expects_walks(inputs.medium(), body, layered, inputs.knobs) &&
                          (may_hold || !inputs.layout.at_entry);
    const bool is_doubted = inputs.knobs.error_target > 0 && !is_fixed(inputs.medium()) &&
                            asked == MultipleModel::dipole && choice.dipole_error > allowed;
    if (body.varies && may_walk) {
        choice.model = MultipleModel::walks;
        return choice;
    }
    const bool is_measured = is_doubted || (may_walk && measures_models(inputs.knobs));
    if (may_walk && (layered || body.overlaps ||
                     (choice.all_orders && is_too_peaked(inputs.medium(), inputs.knobs)))) {
        choice.model = MultipleModel::walks;
        return choice;
    }
    if (is_measured) {
        choice.dipole = measure_models(inputs, profile, traced);
    } else if (may_walk && !body.has_thickness()) {
        choice.is_found = true;
        choice.dipole_error = body_error(inputs, profile);
    }
    const bool has_measured = choice.dipole.receivers > 0;
    if (has_measured) {
        choice.dipole_error = choice.dipole.error;
    }
    if (may_walk && has_measured == is_measured && choice.dipole_error > allowed) {
        choice.model = MultipleModel::walks;
    }
    return choice;
}

bool takes_walks_alone(const formats::Medium& medium, const RowLayout& layout, const Knobs& knobs) {
    const auto asked = static_cast<MultipleModel>(whole(knobs, kMultipleModel));
    return !layout.at_entry && (asked == MultipleModel::walks ||
                                (asked == MultipleModel::automatic && !is_fixed(medium)));
}

PlanEntry decide_model(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    entry.alternative = true;
    const double error = expected_error(medium, input.subject);
    const PlanEntry& effect = *earlier_entry(input, "multiple");
    const PlanEntry* const layers = earlier_entry(input, "multiple.layers");
    const bool layered = layers != nullptr && layers->on;
    entry.bound = effect.on ? error * effect.bound : 0;
    const auto asked = static_cast<MultipleModel>(whole(input.knobs, kMultipleModel));
    const double allowed = allowed_model_error(input.knobs);
    const auto walk = [&](const std::string& reason) {
        entry.on = true;
        entry.choice = kMultipleModel.words[static_cast<std::size_t>(MultipleModel::walks)];
        entry.reason = "walks: " + reason;
    };
    if (asked != MultipleModel::automatic) {
        entry.on = asked != MultipleModel::dipole;
        entry.reason = std::string(kMultipleModel.words[static_cast<std::size_t>(asked)]) +
                       ": as --multiple-model says";
    } else if (input.subject.varies) {
        walk("the medium varies in space, which other models do not know");
    } else if (is_fixed(medium)) {
        entry.reason = "dipole: the medium names its profile";
    } else if (layered) {
        walk("it contains other media");
    } else if (input.subject.overlaps && effect.on) {
        walk("bodies of it touch or overlap, whose hidden faces the dipole takes for surface");
    } else if (!effect.on) {
        entry.reason = "dipole: no light that scatters many times is simulated";
    } else if (is_too_peaked(medium, input.knobs)) {
        walk(
            "the medium scatters in a peak, which the dipole leaves to terms in the view that err "
            "by some " +
            percent(peak_error(medium)));
    } else if (error <= allowed) {
        entry.reason = "dipole: the body is so thick that it errs by some " + percent(error);
    } else if (measures_models(input.knobs)) {
        entry.on = true;
        entry.reason =
            "measured before the bake: the dipole, or random walks where it errs by "
            "more than " +
            percent(allowed);
    } else if (!input.subject.has_thickness()) {
        entry.on = true;
        entry.reason =
            "found before the bake: the dipole, or random walks where the body is so thin that it "
            "errs by more than " +
            percent(allowed);
    } else {
        walk("the dipole takes every surface for that of a half space, which errs by some " +
             percent(error));
    }
    if (effect.on && entry.choice.empty()) {
        entry.choice = asked != MultipleModel::automatic
                           ? kMultipleModel.words[static_cast<std::size_t>(asked)]
                       : entry.on ? std::string_view()
                                  : "dipole";
    }
    entry.all_orders =
        effect.on && entry.on && (layered || hold_all_orders(medium, input.subject, input.knobs));
    entry.model_error = !effect.on         ? 0
                        : !entry.on        ? error
                        : entry.all_orders ? walks_error(medium)
                                           : 0;
    return entry;
}

void describe_choice(const ModelChoice& choice, PlanEntry& entry) {
    entry.choice = kMultipleModel.words[static_cast<std::size_t>(choice.model)];
    const bool was_on = std::exchange(entry.on, choice.model != MultipleModel::dipole);
    entry.all_orders = choice.model == MultipleModel::walks && choice.all_orders;
    entry.model_error = choice.error();
    if (choice.dipole.receivers == 0) {
        if (choice.is_found) {
            entry.reason =
                std::string(entry.choice) + ": the body is so " + (entry.on ? "thin" : "thick") +
                " along rays into it that the dipole errs by some " + percent(choice.dipole_error);
        } else if (was_on && !entry.on) {
            entry.reason = "dipole: light leaves where it entered";
        }
        return;
    }
    entry.reason =
        std::string(entry.choice) + ": measured at " + std::to_string(choice.dipole.receivers) +
        " vertices, the dipole differs from random walks by " + percent(choice.dipole.error);
}

std::optional<formats::Diagnostic> describe_unfinished(const std::string& material,
                                                       const WalkCounts& counts) {
    constexpr double kNoticed = 1e-3;
    if (counts.walks == 0) return std::nullopt;
    const double share = counts.unfinished() / static_cast<double>(counts.walks);
    if (share < kNoticed) return std::nullopt;
    std::string ends;
    for (const auto& [count, end] :
         {std::pair{counts.lost, "leave through holes of its mesh"},
          {counts.endless, "scatter too often to be followed"},
          {counts.buried, "pass through too many media in each other"}}) {
        if (count > 0) {
            ends += (ends.empty() ? "" : ", ") + std::to_string(count) + " " + end;
        }
    }
    return formats::make_warning(
        "", "material '" + material + "'",
        "of " + std::to_string(counts.walks) + " random walks " + ends + ": " + percent(share) +
            " of their light" +
            (counts.correction() != 1 ? ", which counts as bright as the rest"
                                      : ", too much to be made up for by the rest, is missing"),
        counts.lost > 0 ? "close the surface" : "--check-model measures what that errs by");
}

}  // namespace opaline::bake
