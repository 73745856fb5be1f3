#include "bake/effects/multiple/multiple_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/walks/walk_stage.h"
#include "bake/physics/dipole.h"
#include "bake/physics/fresnel.h"
#include "bake/plan/plan_input.h"
#include "bake/plan/stage_work.h"
#include "bake/receivers/kd_order.h"
#include "formats/media/mean_cosine.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

using std::numbers::pi;

constexpr double kGreyEntry = 0.8;  // cost of one band over that of three; measured

constexpr CostBySize kSharedTexel{2.6e-8, 5.5e-8};  // irradiance of a sample, with shared rays
constexpr double kSumEntry = 2.9e-9;                // one entry of a sample into the sum of a node
constexpr double kTakeWeight = 5.8e-8;  // per accepted node or sample, traversal included
// The surface integral of a truth: its triangles, and rays of its points to all lights.
constexpr double kSplitTriangle = 5.3e-8;
constexpr CostBySize kSurfacePoint{4.9e-6, 6.7e-6};

double texels(std::uint32_t n) {
    return static_cast<double>(formats::cubemap_texels(n));
}

std::array<Dipole, 3> dipoles_of(const formats::Medium& medium) {
    const double g = formats::mean_cosine(medium.phase);
    const auto make = [&](const Band& band) {
        return make_dipole(DipoleKind::better, (1 - g) * band.sigma_s, band.sigma_a,
                           static_cast<double>(medium.eta));
    };
    const auto bands = bands_of(medium);
    return {make(bands[0]), make(bands[1]), make(bands[2])};
}

// Depth of the source of the densest band that returns light; infinite: there is none.
double least_depth(const std::array<Dipole, 3>& dipoles) {
    double depth = HUGE_VAL;
    for (const Dipole& d : dipoles) {
        depth = dipole_total(d) > 0 ? std::min(depth, d.z_real) : depth;
    }
    return depth;
}

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

// As count_served has it; receivers of rows may be a part of the material's.
double served_by_samples(const SubjectCost& cost) {
    return std::max(cost.receivers, cost.facts.receivers);
}

SitePlan plan_of(const SubjectCost& cost) {
    SitePlan plan = expected_sites(cost.medium(), cost.facts, cost.input.knobs);
    plan.is_residual = plan.is_residual && !cost.layout.layered;
    widen_for_receivers(plan, cost.facts.area,
                        static_cast<double>(glm::length(cost.facts.high - cost.facts.low)),
                        served_by_samples(cost));
    return plan;
}

// Of sites on the surface: the share of it that lies within the radius of a receiver.
double share_read(const SubjectCost& cost, const SitePlan& plan) {
    const double radius = (rows_by_view(cost.layout) > 0 ? 2 : 1) * plan.radius;
    return std::min(1.0, cost.receivers * pi * radius * radius / cost.facts.area);
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

double expected_samples(const formats::Medium& medium, double area, double receivers,
                        const Knobs& knobs) {
    if (knobs.is_given(kSamples)) return knobs[kSamples];
    return count_samples(area, least_depth(dipoles_of(medium)),
                         {knobs[kSamplesPerPath], knobs[kSamples], receivers});
}

double count_weights(const formats::Medium& medium, const MaterialFacts& facts, double samples,
                     double tolerance) {
    constexpr double kRounding = 1.44;  // accepted nodes have 1/2 to 1 of the allowed area
    const double sample_area = facts.area / samples;
    const double reach = std::sqrt(facts.area / pi);
    double count = 0;
    // Rings, evenly spaced in the logarithm of their radius.
    constexpr int kRings = 48;
    const auto dipoles = dipoles_of(medium);
    const double smallest = least_depth(dipoles);
    if (!std::isfinite(smallest)) return 0;
    const double nearest = std::min(0.1 * std::max(smallest, std::sqrt(sample_area)), 0.5 * reach);
    const double step = std::log(reach / nearest) / kRings;
    const auto far = [&](const Dipole& d, double r) {
        const double wanted = kWidthPerSpacing * std::sqrt(sample_area);
        const double b2 = std::max(0.0, wanted * wanted - d.z_real * d.z_real);
        return eval_dipole(d, std::sqrt(r * r + b2));
    };
    const auto may_take = [&](double r, double patch) {
        const double side = std::sqrt(patch);
        for (const Dipole& d : dipoles) {
            const double change = far(d, std::max(0.0, r - 0.5 * side)) - far(d, r + 0.7 * side);
            if (patch * change > tolerance * dipole_total(d)) return false;
        }
        return true;
    };
    for (int i = 0; i < kRings; ++i) {
        const double inner = i == 0 ? 0 : nearest * std::exp(step * i);
        const double outer = nearest * std::exp(step * (i + 1));
        const double r = 0.5 * (inner + outer);
        double patch = facts.area;
        while (patch > sample_area && !may_take(r, patch)) {
            patch *= 0.84;
        }
        const double taken = patch / kRounding;
        count += pi * (outer * outer - inner * inner) /
                 (taken < kSamplesPerLeaf * sample_area ? sample_area : taken);
    }
    return std::min(count, samples);
}

Work profile_work(const SubjectCost& cost) {
    // make_medium_profile: these two are not matched to the half space.
    const formats::Medium& medium = cost.medium();
    if (medium.profile == formats::Medium::Profile::classic ||
        medium.fidelity == formats::Medium::Fidelity::paper) {
        return {};
    }
    return even_light_work();
}

Work samples_work(const SubjectCost& cost) {
    const CostInput& input = cost.input;
    const Knobs& knobs = input.knobs;
    const double samples =
        expected_samples(cost.medium(), cost.facts.area, served_by_samples(cost), knobs);
    const double own = texels(knobs.cubemap_size);
    Work work{samples * kPlaceSample, 0};
    const double seen = !cost.layout.occluded ? 0.5 * kOpenCell  // half are below the horizon
                        : knobs.exact_rays    ? 0.5 * kCoherentRay.at(input.triangles)
                                              : kSharedTexel.at(input.triangles);
    work.shared += samples * own * (seen + kTruncateTexel);
    // build_cluster_tree: each level adds all samples up; each node is truncated.
    const double levels = std::max(1.0, std::ceil(std::log2(samples / kSamplesPerLeaf)) + 1);
    const double nodes = 2 * samples / kSamplesPerLeaf;
    work.shared +=
        samples * levels * kept_by_samples(knobs) * kSumEntry + nodes * own * kTruncateTexel;
    if (expects_walks(cost.medium(), cost.facts, cost.layout.layered, knobs)) {
        work += walks_work(cost);
    }
    return work;
}

Work multiple_rows_work(const SubjectCost& cost) {
    const Knobs& knobs = cost.input.knobs;
    const double samples =
        expected_samples(cost.medium(), cost.facts.area, served_by_samples(cost), knobs);
    const double weights = count_weights(cost.medium(), cost.facts, samples, knobs[kEpsilon]);
    if (expects_walks(cost.medium(), cost.facts, cost.layout.layered, knobs)) {
        return walked_rows_work(cost);
    }
    const double entry = kGatherEntry * (cost.layout.bands() == 1 ? kGreyEntry : 1);
    return {0, cost.receivers * weights * (kTakeWeight + kept_by_samples(knobs) * entry)};
}

Work multiple_truth_work(const SubjectCost& cost, double points) {
    return {0, cost.receivers * (cost.facts.triangles * kSplitTriangle +
                                 2 * points * kSurfacePoint.at(cost.input.triangles))};
}

double sample_bytes(const Knobs& knobs) {
    constexpr double kSampleOverhead = 200;  // itself, its place in the tree
    constexpr double kEntry = 8;             // of its vector: index and value
    constexpr double kTree = 2;              // nodes hold as much as the samples
    constexpr double kMoments = 0.75;        // of a sample's entries
    constexpr double kSiteEntry = 16;        // of a site's row: index and three values
    const bool may_walk =
        static_cast<MultipleModel>(whole(knobs, kMultipleModel)) != MultipleModel::dipole;
    const double walked = may_walk ? kMoments * knobs[kSamples] * kept_by_samples(knobs) * kEntry +
                                         knobs[kSites] * kept_by_samples(knobs) * kSiteEntry
                                   : 0;
    return walked + knobs[kSamples] * (kSampleOverhead + kTree * kept_by_samples(knobs) * kEntry);
}

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
    const double share = are_inside(cost, plan) ? 1 : share_read(cost, plan);
    const double walks = share * std::max(count_walks(plan, cost.facts.area, budget_of(knobs)),
                                          static_cast<double>(plan.sites));
    const double views = are_inside(cost, plan) ? 0 : rows_by_view(cost.layout);
    const double entries =
        kOwnSample * (kCellEntries + (1 + views) * kept_by_samples(knobs)) * kGatherEntry;
    const double dense = static_cast<double>(formats::cubemap_texels(knobs.cubemap_size));
    // Measured on Spot: an event with veins to evaluate takes as long as three without.
    const auto& variation = cost.medium().variation;
    const double looked_up = !variation ? 1 : variation->marble ? 3 : 1.5;
    return {plan.sites * kPlaceSample,
            walks * (looked_up * count_steps(cost.medium(), cost.facts) *
                         kBodyEvent.at(cost.input.triangles) +
                     kExitsPerWalk * (kWalkExit + entries)) +
                share * plan.sites * (1 + views) * dense * kTruncateTexel};
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
