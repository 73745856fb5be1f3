#include "bake/effects/multiple/walk_costs.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/walks/walk_balls.h"
#include "bake/plan/plan_input.h"
#include "bake/plan/walk_work.h"
#include "bake/scattering/fresnel.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr double kWalkExit = 2.1e-7;                // the sample at a walk's exit
constexpr double kSiteWeight = 1.3e-7;              // of a site around a receiver, the fit included
constexpr CostBySize kFirstFlight{2.7e-5, 4.2e-5};  // of a receiver, with all its views
constexpr CostBySize kInnerSite{6.5e-7, 9.5e-7};    // in view of a receiver, the fit included

constexpr double kExitsPerWalk = 1.5;  // measured at indices from 1.3 to 1.5
constexpr double kCellEntries = 250;   // an exit's lobe in 96 cells, in entries of a row
constexpr double kOwnSample = 0.6;     // exits that share their sample with none of the site's

WalkBudget budget_of(const Knobs& knobs) {
    return {knobs[kWalksAround], knobs[kWalks], whole(knobs, kSites)};
}

double rows_by_view(const RowLayout& layout) {
    return layout.view_harmonics > 0 ? layout.view_harmonics - 1.0 : 0.0;
}

// Walks begin with a scattering inside (multiple_stage.cpp).
bool are_inside(const SubjectCost& cost, const SitePlan& plan) {
    return !plan.is_residual && cost.layout.all_orders && !cost.layout.layered &&
           !cost.facts.varies;
}

// Of the media inside as well [m].
double shortest_path(const formats::Medium& medium, const MaterialFacts& body) {
    std::vector<const formats::Medium*> media{&medium};
    for (const InnerMedium& inner : body.inner) {
        media.push_back(&inner.medium);
    }
    return shortest_transport_path(media);
}

SitePlan plan_of(const SubjectCost& cost) {
    return expected_sites(cost.medium(), cost.facts, cost.input.knobs);
}

// What a walk costs in events. Balls save walks of hundreds of events most of them; measured on the
// statue (tests/bench/RESULTS.md, "Balls").
double count_steps(const formats::Medium& medium, const MaterialFacts& body) {
    constexpr double kMost = 130;
    const double events = count_body_events(medium, body);
    const auto diagonal = static_cast<double>(glm::length(body.high - body.low));
    const double g = formats::mean_cosine(medium.phase);
    const auto has_balls = [&](const Band& band) {
        const double sigma_t = band.sigma_s + band.sigma_a;
        return band.sigma_s > 0 && largest_ball(band.sigma_s / sigma_t, g, diagonal * sigma_t) > 0;
    };
    const auto bands = bands_of(medium);
    return !medium.variation && std::any_of(bands.begin(), bands.end(), has_balls)
               ? events / (1 + events / kMost)
               : events;
}

}  // namespace

double kept_by_samples(const Knobs& knobs) {
    return std::min(static_cast<double>(sample_coefficients(knobs)),
                    static_cast<double>(formats::cubemap_texels(knobs.cubemap_size)));
}

SitePlan expected_sites(const formats::Medium& medium, const MaterialFacts& body,
                        const Knobs& knobs) {
    const auto diagonal = static_cast<double>(glm::length(body.high - body.low));
    return plan_sites(body.area, diagonal, shortest_path(medium, body), budget_of(knobs));
}

double count_body_events(const formats::Medium& medium, const MaterialFacts& body) {
    const auto eta = static_cast<double>(medium.eta);
    const double chord = body.has_thickness() ? 4 * std::abs(body.volume) / body.area
                                              : 2.0 / 3 * std::sqrt(body.area / std::numbers::pi);
    const double escape = std::max(1e-3, 1 - fresnel_moments(eta).external);
    double most = 0;
    for (const Band& band : bands_of(medium)) {
        const double sigma_t = band.sigma_s + band.sigma_a;
        if (band.sigma_s > 0) {
            const double conservative =
                std::max(1.0, std::max(1.0, eta * eta) * chord * sigma_t / escape);
            most = std::max(most, 1 / (band.sigma_a / sigma_t + 1 / conservative));
        }
    }
    return 1 + most;
}

Work walks_work(const SubjectCost& cost) {
    const Knobs& knobs = cost.input.knobs;
    if (!(shortest_path(cost.medium(), cost.facts) > 0)) {
        return {};
    }
    const SitePlan plan = plan_of(cost);
    const double walks = std::max(count_walks(plan, cost.facts.area, budget_of(knobs)),
                                  static_cast<double>(plan.sites));
    const double views = are_inside(cost, plan) ? 0 : rows_by_view(cost.layout);
    const double entries =
        kOwnSample * (kCellEntries + (1 + views) * kept_by_samples(knobs)) * kGatherEntry;
    const double dense = static_cast<double>(formats::cubemap_texels(knobs.cubemap_size));
    // Measured on Spot: an event with veins to evaluate takes as long as three without.
    const auto& variation = cost.medium().variation;
    const double looked_up = !variation ? 1 : variation->marble ? 3 : 1.5;
    return {plan.sites * kPlaceSample, walks * (looked_up * count_steps(cost.medium(), cost.facts) *
                                                    kBodyEvent.at(cost.input.triangles) +
                                                kExitsPerWalk * (kWalkExit + entries)) +
                                           plan.sites * (1 + views) * dense * kTruncateTexel};
}

Work walked_rows_work(const SubjectCost& cost) {
    if (!(shortest_path(cost.medium(), cost.facts) > 0)) {
        return {};
    }
    const SitePlan plan = plan_of(cost);
    const double sites = std::min(std::numbers::pi * plan.radius * plan.radius * plan.sites /
                                      std::max(cost.facts.area, 1e-300),
                                  static_cast<double>(plan.sites));
    if (are_inside(cost, plan)) {
        const double wider =
            inner_radius(plan, shortest_path(cost.medium(), cost.facts)) / plan.radius;
        const double seen = std::min(wider * wider * sites, static_cast<double>(plan.sites));
        return {0,
                cost.receivers * (kFirstFlight.at(cost.input.triangles) +
                                  seen * (kInnerSite.at(cost.input.triangles) +
                                          (1 + rows_by_view(cost.layout)) *
                                              kept_by_samples(cost.input.knobs) * kGatherEntry))};
    }
    // By view: four times as many sites, of each three or eight rows with a quarter of the entries.
    const double views = rows_by_view(cost.layout);
    return {0, cost.receivers * sites *
                   ((views > 0 ? 5 : 1) * kSiteWeight +
                    (1 + views) * kept_by_samples(cost.input.knobs) * kGatherEntry)};
}

}  // namespace opaline::bake
