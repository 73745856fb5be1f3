#include "bake/effects/multiple/multiple_costs.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bake/effects/multiple/choose_model.h"
#include "bake/effects/multiple/gather_profile.h"
#include "bake/effects/multiple/medium_profile.h"
#include "bake/effects/multiple/multiple_knobs.h"
#include "bake/effects/multiple/walk_costs.h"
#include "bake/plan/plan_input.h"
#include "bake/plan/walk_work.h"
#include "bake/receivers/kd_order.h"
#include "bake/scattering/dipole.h"
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

}  // namespace

double expected_samples(const formats::Medium& medium, double area, const Knobs& knobs) {
    const double per_path = knobs[kSamplesPerPath];
    const double least = kLeastSamplesPerPath * per_path;
    const double most = knobs[kSamples];
    if (knobs.is_given(kSamples)) {
        return most;
    }
    const double depth = least_depth(dipoles_of(medium));
    return std::clamp(per_path * area / (depth * depth), std::min(least, most), most);
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
    if (!std::isfinite(smallest)) {
        return 0;
    }
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
            if (patch * change > tolerance * dipole_total(d)) {
                return false;
            }
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
    // make_medium_profile: these two are not matched to a walk.
    const formats::Medium& medium = cost.medium();
    if (medium.profile == formats::Medium::Profile::classic ||
        medium.fidelity == formats::Medium::Fidelity::paper) {
        return {};
    }
    return walk_work(medium);
}

Work samples_work(const SubjectCost& cost) {
    const CostInput& input = cost.input;
    const Knobs& knobs = input.knobs;
    const double samples = expected_samples(cost.medium(), cost.facts.area, knobs);
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
    const double samples = expected_samples(cost.medium(), cost.facts.area, knobs);
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

}  // namespace opaline::bake
