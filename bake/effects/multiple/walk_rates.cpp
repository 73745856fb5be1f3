#include "bake/effects/multiple/walk_rates.h"

#include <algorithm>
#include <vector>

#include "bake/calibration/bench/stopwatch.h"
#include "bake/effects/multiple/walks/inner_field.h"
#include "bake/effects/multiple/walks/inner_sites.h"
#include "bake/effects/multiple/walks/site_field.h"
#include "bake/effects/multiple/walks/site_rows.h"

namespace opaline::bake {
namespace {

// Rows of receivers from sites inside.
void calibrate_inner_rows(const CalibrationBench& bench, const WalkSpace& space,
                          std::span<const SurfaceSample> samples, Rates& rates) {
    constexpr std::size_t kSites = 4000, kReceivers = 64;
    constexpr std::uint32_t kRows = 4;
    const InnerField field(make_inner_starts(space, thinned(samples, kSites), one_thread()), 0.25f,
                           0.25f, true);  // of a ball of radius 1 m: some sixty sites
    const auto eta = static_cast<double>(space.eta);
    const ViewFit fit = make_view_fit(eta);
    const auto points = bench.neighbours_together();
    const std::vector<BodyPoint> receivers =
        thinned(std::span<const BodyPoint>(points), kReceivers);
    std::vector<ViewSet> views;
    std::vector<FirstFlight> flights;
    Stopwatch watch;
    for (const BodyPoint& point : receivers) {
        views.push_back(make_view_set(fit, eta, point.normal, kRows));
        flights.push_back(trace_first_flight(space, views.back(), point));
    }
    const auto count = static_cast<double>(std::max<std::size_t>(1, receivers.size()));
    bench.side_of(rates.first_flight) = watch.seconds() / count;
    std::vector<InnerWeight> weights;
    double weighed = 0;
    watch.restart();
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        field.weigh(space, receivers[i], views[i], flights[i], kRows, weights);
        weighed += static_cast<double>(weights.size());
    }
    bench.side_of(rates.inner_site) = watch.seconds() / std::max(1.0, weighed);
}

}  // namespace

void calibrate_walks(const CalibrationBench& bench, std::span<const SurfaceSample> samples,
                     Rates& rates) {
    constexpr std::size_t kStarts = 256;
    constexpr std::uint32_t kFromEach = 8;
    const WalkSpace space = make_walk_space(bench.scene, bench.rays.hierarchy(), 0, true);
    const std::vector<SurfaceSample> sites = thinned(samples, kStarts);
    const std::vector<WalkStart> starts = make_walk_starts(space, sites, one_thread());
    std::vector<WalkExit> exits;
    WalkCounts counts;
    Stopwatch watch;
    for (std::uint32_t s = 0; s < starts.size(); ++s) {
        for (std::uint32_t w = 0; w < kFromEach; ++w) {
            WalkRandom random({0, RandomStage::body_walk, s, w});
            follow_walk(space, {}, starts[s], {}, random, exits, counts);
        }
    }
    bench.side_of(rates.body_event) =
        watch.seconds() / static_cast<double>(std::max<std::uint64_t>(1, counts.events));
    calibrate_inner_rows(bench, space, samples, rates);
    if (!bench.is_many || exits.empty()) {
        return;
    }
    const SparseVectors none;
    const ExitLight light(samples, none, std::nullopt, 1);
    std::vector<std::uint32_t> around;
    watch.restart();
    for (const WalkExit& exit : exits) {
        light.nearest(exit, around);
    }
    rates.walk_exit = watch.seconds() / static_cast<double>(exits.size());
    const SiteField field(samples, 0.15f);  // of a ball of radius 1 m: twenty samples or so
    std::vector<SiteWeight> weights;
    double weighed = 0;
    watch.restart();
    for (const SurfaceSample& site : sites) {
        field.weigh(site.position, site.normal, weights);
        weighed += static_cast<double>(weights.size());
    }
    rates.site_weight = watch.seconds() / std::max(1.0, weighed);
}

}  // namespace opaline::bake
