#include "bake/plan/accuracy_costs.h"

#include <algorithm>
#include <cmath>

namespace opaline::bake {
namespace {

// Of the receivers, one material's.
double share_of(const CostedBake& bake, std::uint32_t m) {
    return bake.facts.receivers > 0 ? bake.facts.material[m].receivers / bake.facts.receivers : 0;
}

// Of `opaque` receivers out of all materials', and of media as if `translucent` were.
void add_truth(const CostedBake& bake, double opaque, double translucent, const TruthEffort& effort,
               Bill& bill) {
    for (std::uint32_t m = 0; m < bake.layouts.size(); ++m) {
        const double share = share_of(bake, m);
        if (bake.layouts[m].direct) {
            bill.add(direct_check_work(bake.input, share * opaque, needs_hierarchy(bake.layouts)));
        } else if (bake.layouts[m].translucent) {
            bill.add(medium_check_work(bake.input, bake.facts.material[m], bake.layouts[m],
                                       share * translucent, effort));
        }
    }
}

// As find_pilot_truth draws them.
constexpr double kMostPilotTranslucent = 192;
constexpr std::uint32_t kEncodings = 26;

double pilot_receivers(const CostedBake& bake) {
    const double receivers = bake.facts.receivers;
    return std::min(receivers, std::clamp(receivers / 40, 64.0, 1024.0));
}

}  // namespace

void bill_pilot_truth(const CostedBake& bake, Bill& bill) {
    bill.open("pilot truth");
    const double drawn = pilot_receivers(bake), target = bake.input.knobs.error_target;
    add_truth(bake, drawn, std::min(drawn, kMostPilotTranslucent),
              {target >= 0.03    ? 256.0
               : target >= 0.015 ? 512.0
                                 : 1024.0,
               target >= 0.03 ? 8.0 : 16.0},
              bill);
}

void bill_opaque_trials(const CostedBake& bake, Bill& bill) {
    bill.open("pilot");
    double share = 0;
    for (std::uint32_t m = 0; m < bake.layouts.size(); ++m) {
        share += bake.layouts[m].direct ? share_of(bake, m) : 0;
    }
    const double opaque = share * pilot_receivers(bake);
    bill.add(direct_rows_work(bake.input, opaque, needs_hierarchy(bake.layouts)));
    bill.add(encode_work(bake.input, kEncodings, 1, opaque));
}

// Single scattering by rays.
void bill_media_trials(const CostedBake& bake, Bill& bill) {
    constexpr double kRounds = 4;
    constexpr std::uint32_t kDepthSamples = 10;
    bill.open("pilot");
    const double translucent = std::min(pilot_receivers(bake), kMostPilotTranslucent);
    Knobs by_rays = bake.input.knobs;
    by_rays.exact_rays = true;
    by_rays.depth_samples = kDepthSamples;
    const CostInput traced{bake.input.rates, by_rays, bake.input.triangles, bake.input.receivers};
    for (std::uint32_t m = 0; m < bake.layouts.size(); ++m) {
        const RowLayout& layout = bake.layouts[m];
        const MaterialFacts& facts = bake.facts.material[m];
        const double own = translucent * share_of(bake, m);
        if (!layout.translucent) {
            continue;
        }
        if (layout.multiple) {
            bill.add(multiple_rows_work(bake.input, bake.medium(m), facts, layout.bands(),
                                        kRounds * own));
        }
        if (layout.single_terms > 0) {
            bill.add(single_rows_work(traced, facts, layout.single_terms, layout.bands(), own));
        }
        bill.add(encode_work(bake.input, kEncodings * layout.terms(), layout.bands(), own));
    }
}

void bill_self_check(const CostedBake& bake, Bill& bill) {
    constexpr double kMostChecked = 256;
    bill.open("self-check");
    const double receivers = bake.facts.receivers;
    const double drawn = std::min(receivers, std::clamp(receivers / 40, 32.0, 1024.0));
    add_truth(bake, drawn, drawn / std::max(1.0, std::ceil(drawn / kMostChecked)),
              {1024, 2.0 * bake.input.knobs.depth_samples}, bill);
}

}  // namespace opaline::bake
