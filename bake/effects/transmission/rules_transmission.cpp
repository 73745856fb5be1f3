#include "bake/effects/transmission/rules_transmission.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {
namespace {

// The clearest band's share, of a body in which balls of that diameter [m] roll.
double largest_share(const formats::Medium& medium, double diameter) {
    double share = 0;
    for (const auto& [sigma_s, sigma_a] : bands_of(medium)) {
        share = std::max(
            share, straight_share(static_cast<double>(medium.eta), (sigma_s + sigma_a) * diameter));
    }
    return share;
}

double mean_thickness(const MaterialFacts& body) {
    return body.has_thickness() ? 2 * std::abs(body.volume) / body.area : 0;
}

// Of even light. One row for all views shows each as much as the others.
double allowed_share(const Knobs& knobs) {
    if (knobs.error_target > 0) return knobs.error_target;
    switch (knobs.quality) {
        case Quality::draft:
            return 0.5;
        case Quality::preview:
            return 0.2;
        case Quality::production:
            return 0.05;
        case Quality::reference:
            break;
    }
    return 0.01;
}

std::string percent(double share) {
    return std::to_string(static_cast<int>(std::lround(100 * share))) + " %";
}

}  // namespace

double straight_share(double eta, double depth) {
    const GaussLegendre rule = make_gauss_legendre(64);
    // Below eta = 1 nothing enters beyond the critical angle.
    const double least = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    double sum = 0, crossed = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double c = least + (1 - least) * rule.node[i];
        const double p = rule.weight[i] * c * fresnel_transmittance(c, eta);
        sum += p;
        crossed += p * std::exp(-depth * refracted_cosine(c, eta));
    }
    return crossed / sum;
}

double typical_share(const formats::Medium& medium, const MaterialFacts& body) {
    // Balls that roll in a slab are as wide as it is thick; in a ball, three times as wide as its
    // mean thickness 2 V / A.
    constexpr double kWidth = 1.5;
    return largest_share(medium, kWidth * mean_thickness(body));
}

double thin_share(const formats::Medium& medium, const MaterialFacts& body) {
    // As rule `multiple.spread` has it: a quarter of the mean thickness.
    constexpr double kThinParts = 0.25;
    return largest_share(medium, kThinParts * mean_thickness(body));
}

PlanEntry decide_transmission(const PlanInput& input) {
    const formats::Medium& medium = *input.material.medium;
    PlanEntry entry;
    entry.has_bands = true;
    const bool is_unknown = medium.variation && medium.variation->density.image != formats::kNone;
    entry.bound = is_unknown ? 1 : thin_share(medium, input.subject);
    if (!is_wanted(input.knobs, "transmission")) {
        entry.reason = "left out by --effects";
    } else if (medium.fidelity == formats::Medium::Fidelity::paper &&
               !is_named(input.knobs, "transmission")) {
        entry.reason = "the paper has no light that crosses a body unscattered";
    } else if (!(entry.on = is_worth(entry.bound, input, entry.forced))) {
        // Near edges some does, at any density: rows of what scatters stand for it.
        entry.all_orders = !is_named(input.knobs, "transmission");
        entry.reason = "the medium is so dense that hardly any light crosses it unscattered";
    } else if (is_unknown) {
        entry.reason = "light may cross the body unscattered: its density varies";
    } else {
        entry.reason = input.subject.has_thickness()
                           ? "light crosses thin parts of the body unscattered"
                           : "light may cross the open body unscattered: how thick it is, is not "
                             "known";
    }
    return entry;
}

PlanEntry decide_straight_views(const PlanInput& input) {
    const PlanEntry& effect = input.earlier.back();
    const auto given = whole(input.knobs, kStraightTerms);
    const double share =
        input.subject.has_thickness() ? typical_share(*input.material.medium, input.subject) : 0;
    constexpr double kMuch = 0.2;
    PlanEntry entry;
    entry.least_terms = 4;
    entry.terms = 1;
    entry.bound = effect.on ? effect.bound : 0;
    entry.alternative = !effect.on;
    if (!effect.on) {
        entry.reason = "no light that crosses bodies is simulated";
    } else if (input.knobs.separate_terms) {
        entry.reason = "one row for all views stands apart, as --separate-terms says";
    } else if (given > 0) {
        entry.terms = given;
        entry.reason = std::to_string(given) + (given == 1 ? " row" : " rows") +
                       ", as --transmission-terms says";
    } else if (share > allowed_share(input.knobs)) {
        const bool is_fine =
            input.knobs.quality >= Quality::production || input.knobs.error_target > 0;
        entry.terms = is_fine && share > kMuch ? 9 : 4;
        entry.reason = std::to_string(entry.terms) + " rows: about " + percent(share) +
                       " of even light crosses the body, and views differ";
    } else {
        entry.reason = input.subject.has_thickness()
                           ? "one row for all views: about " + percent(share) +
                                 " of even light crosses the body"
                           : "one row for all views: how thick the open body is, is not known";
    }
    entry.on = entry.terms > 1;
    return entry;
}

void warn_of_reach(const PlanInput& input, const PlanEntry& entry,
                   std::vector<formats::Diagnostic>& warnings) {
    constexpr double kLeastError = 0.25;
    const double target = input.knobs.error_target;
    if (!(target > 0) || !(entry.bound > 0)) return;
    const double share = typical_share(*input.material.medium, input.subject);
    if (kLeastError * share <= target) return;
    const bool is_known = input.subject.has_thickness();
    std::array<char, 32> asked{};
    std::snprintf(asked.data(), asked.size(), "%.3g %%", 100 * target);
    warnings.push_back(formats::make_warning(
        "", entry.subject.name,
        "--error: " + std::string(asked.data()) +
            (is_known ? " is out of reach: some " + percent(share) +
                            " of even light crosses the body unscattered, and rows that blur it "
                            "err by a quarter of that at least"
                      : " may be out of reach: how thick the open body is, is not known, and where "
                        "it is thin, rows blur the light that crosses it"),
        std::string(is_known ? "" : "close the surface, ") +
            "allow a larger error, or leave transmission out with --effects and let the host "
            "refract such light"));
}

}  // namespace opaline::bake
