#include "bake/effects/transmission/transmission_costs.h"

#include <algorithm>
#include <vector>

#include "bake/effects/transmission/rules_transmission.h"
#include "bake/effects/transmission/straight_rows.h"
#include "bake/effects/transmission/view_fit.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

// A view through a body: its flights, and rays beyond its exits. A texel of one row and band, and
// half an exit's share of one.
constexpr CostBySize kStraightView{4.7e-6, 7.6e-6};
constexpr double kStraightCell = 4.7e-9;
// Exits of a view, each in sixteen parts.
constexpr double kPartsPerView = 32;

double cells(double texels, double views, double rows) {
    return rows * (texels + kPartsPerView * views);
}

}  // namespace

Work straight_rows_work(const SubjectCost& cost, double views) {
    const auto texels = static_cast<double>(formats::cubemap_texels(cost.input.knobs.cubemap_size));
    const double rows = straight_terms(cost.layout) * cost.layout.bands();
    // Where a medium is dense, one short flight is all of a view, and few receivers have exits.
    constexpr double kOneFlight = 0.2;
    const double crossing = thin_share(cost.medium(), cost.facts);
    const double view = kStraightView.at(cost.input.triangles);
    return {0, cost.receivers * (views * view * (kOneFlight + (1 - kOneFlight) * crossing) +
                                 crossing * cells(texels, views, rows) * kStraightCell)};
}

Work straight_truth_work(const SubjectCost& cost, double views) {
    return {0, cost.receivers * views * kStraightView.at(cost.input.triangles)};
}

}  // namespace opaline::bake
