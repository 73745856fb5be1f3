#include "bake/effects/transmission/transmission_costs.h"

#include <algorithm>
#include <vector>

#include "bake/calibration/bench/stopwatch.h"
#include "bake/effects/transmission/rules_transmission.h"
#include "bake/effects/transmission/straight_rows.h"
#include "bake/effects/transmission/view_fit.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

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
    const double view = cost.input.rates.straight_view.at(cost.input.triangles);
    return {0, cost.receivers *
                   (views * view * (kOneFlight + (1 - kOneFlight) * crossing) +
                    crossing * cells(texels, views, rows) * cost.input.rates.straight_cell)};
}

Work straight_truth_work(const SubjectCost& cost, double views) {
    return {0, cost.receivers * views * cost.input.rates.straight_view.at(cost.input.triangles)};
}

void calibrate_transmission(const CalibrationBench& bench, Rates& rates) {
    constexpr std::uint32_t kViews = 64, kTerms = 4, kBands = 3;
    StraightBody body;
    body.scene = &bench.scene;
    body.rays = body.sky = &bench.rays;
    body.eta = 1.3;
    const std::vector<BodyPoint> points = thinned(std::span<const BodyPoint>(bench.points), 32);
    const auto count = static_cast<double>(points.size());
    Stopwatch watch;
    StraightLight found;
    for (const BodyPoint& point : points) {
        const TransmissionViews views = spread_views(point.normal, body.eta, kViews, {0.5f, 0.5f});
        std::uint64_t traced = 0;
        found = {};
        follow_straight(body, make_straight_start(body, point, traced), views.seen, found);
    }
    const double views = watch.seconds() / count;
    bench.side_of(rates.straight_view) = views / kViews;
    RowLayout layout;
    layout.translucent = layout.constant = true;
    layout.straight_harmonics = kTerms;
    const std::size_t texels = formats::cubemap_texels(kCalibrationCubemap);
    std::vector<float> values(kTerms * kBands * texels);
    const DenseRow row{values, kCalibrationCubemap, kTerms, kBands};
    watch.restart();
    for (const BodyPoint& point : points) {
        add_straight(body, point, kViews, 0, layout, row);
    }
    rates.straight_cell = std::max(0.0, watch.seconds() / count - views) /
                          cells(static_cast<double>(texels), kViews, kTerms * kBands);
}

}  // namespace opaline::bake
