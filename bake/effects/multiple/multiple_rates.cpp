#include "bake/effects/multiple/multiple_rates.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/calibration/bench/stopwatch.h"
#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/multiple/walk_rates.h"
#include "bake/receivers/surface_samples.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kSamples = 4096;
constexpr std::size_t kTraced = 256;  // of them
static_assert(kTraced % SparseVectors::kPerBlock == 0);

// Repeats the traced samples up to the given number, so that a deep tree needs no further rays.
SampleTransport repeated(const SampleTransport& traced, std::size_t samples) {
    SampleTransport all = traced;
    while (all.rows.size() < samples) {
        all.rows.blocks.insert(all.rows.blocks.end(), traced.rows.blocks.begin(),
                               traced.rows.blocks.end());
        all.mean.insert(all.mean.end(), traced.mean.begin(), traced.mean.end());
        all.norm.insert(all.norm.end(), traced.norm.begin(), traced.norm.end());
    }
    return all;
}

double measure_truncation() {
    std::vector<float> dense(formats::cubemap_texels(kCalibrationCubemap));
    SparseVectors::Block vectors;
    constexpr int kVectors = 200;
    double seconds = 0;
    for (int i = 0; i < kVectors; ++i) {
        for (std::size_t k = 0; k < dense.size(); ++k) {
            dense[k] =
                static_cast<float>((k * 2654435761u + 97u * static_cast<unsigned>(i)) % 1021u);
        }
        const Stopwatch watch;
        append_truncated(vectors, dense, kCalibrationKept);
        seconds += watch.seconds();
    }
    return seconds / (kVectors * static_cast<double>(dense.size()));
}

// The cube map is small, so that the sums take longer than their truncation.
double measure_sum_entry(const CalibrationBench& bench, std::span<const SurfaceSample> samples,
                         double truncate_texel) {
    constexpr std::uint32_t kSmall = 8;
    SampleTransport transport =
        repeated(bake_sample_transport(bench.rays, samples.first(kTraced),
                                       {kSmall, kCalibrationKept, 1.3, true}, one_thread()),
                 samples.size());
    const Stopwatch watch;
    const ClusterTree tree =
        build_cluster_tree(samples, std::move(transport), kSmall, kCalibrationKept, one_thread());
    const double seconds = watch.seconds();
    double entries = 0;
    for (const ClusterNode& node : tree.nodes) {
        for (std::size_t s = node.first; s < node.first + node.count; ++s) {
            entries += static_cast<double>(tree.samples[s].index.size());
        }
    }
    const double truncated =
        static_cast<double>(tree.nodes.size() * formats::cubemap_texels(kSmall)) * truncate_texel;
    return std::max(seconds - truncated, 0.1 * seconds) / entries;
}

// A few runs of neighbours, as a bake takes them.
void measure_gather(const CalibrationBench& bench, const ClusterTree& tree,
                    const MediumProfile& medium, Rates& rates) {
    const double spacing = std::sqrt(tree.total_area / kSamples);
    const GatherProfile profile = make_gather_profile(medium, spacing, 4);
    std::vector<ClusterWeight> weights;
    std::vector<float> sums(4 * formats::cubemap_texels(kCalibrationCubemap));
    double collect = 0, gather = 0, taken = 0, gathered = 0;
    constexpr std::size_t kRuns = 5, kRun = 30;
    const std::vector<BodyPoint> points = bench.neighbours_together();
    for (std::size_t i = 0; i < std::min(kRuns * kRun, points.size()); ++i) {
        const BodyPoint& point =
            points[(i / kRun * (points.size() / kRuns) + i % kRun) % points.size()];
        Stopwatch watch;
        collect_weights(tree, profile, point.position, point.normal, {1e-3}, weights);
        collect += watch.seconds();
        watch.restart();
        accumulate(tree, weights, sums);
        gather += watch.seconds();
        taken += static_cast<double>(weights.size());
        gathered += static_cast<double>(weights.size() * kCalibrationKept);
    }
    rates.take_weight = collect / taken;
    rates.gather_entry = gather / gathered;
}

void measure_samples(const CalibrationBench& bench, const MediumProfile& medium, Rates& rates) {
    const Context context = one_thread();
    Stopwatch watch;
    const std::vector<SurfaceSample> samples =
        sample_surface(bench.scene, {0}, kSamples, 0, context);
    rates.place_sample = watch.seconds() / static_cast<double>(samples.size());

    watch.restart();
    const SampleTransport transport =
        bake_sample_transport(bench.rays, std::span(samples).first(kTraced),
                              {kCalibrationCubemap, kCalibrationKept, 1.3, true}, context);
    const double sample = watch.seconds() / kTraced;

    calibrate_walks(bench, samples, rates);
    rates.truncate_texel = measure_truncation();
    const auto texels = static_cast<double>(formats::cubemap_texels(kCalibrationCubemap));
    bench.side_of(rates.shared_texel) = std::max(0.0, sample / texels - rates.truncate_texel);
    if (bench.is_many) {
        rates.sum_entry = measure_sum_entry(bench, samples, rates.truncate_texel);
        measure_gather(bench,
                       build_cluster_tree(samples, repeated(transport, samples.size()),
                                          kCalibrationCubemap, kCalibrationKept, context),
                       medium, rates);
    }
}

// The integral without points splits triangles; its points cost the rest.
void measure_truth(const CalibrationBench& bench, const MediumProfile& medium, Rates& rates) {
    const SurfaceIntegral integral = make_surface_integral(bench.scene, 0, medium);
    const SunRays suns = make_sun_rays(bench.lights, 4);
    const SmoothLights smooth = make_smooth_lights(bench.lights);
    constexpr std::uint32_t kPoints = 256;
    double split = 0, point_rays = 0;
    const auto points = thinned(std::span<const BodyPoint>(bench.points), 8);
    std::uint64_t traced = 0;
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        const auto integrate = [&](std::uint32_t count) {
            const Stopwatch watch;
            integrate_multiple(integral, {bench.scene, bench.rays, suns, smooth, count},
                               points[i].position, {0, i}, traced);
            return watch.seconds();
        };
        const double without = integrate(0);
        split += without;
        point_rays += std::max(0.0, integrate(kPoints) - without);
    }
    const auto count = static_cast<double>(points.size());
    bench.side_of(rates.surface_point) = point_rays / (count * 2 * kPoints);
    if (bench.is_many) {
        rates.split_triangle = split / (count * bench.triangles);
    }
}

}  // namespace

void calibrate_multiple(const CalibrationBench& bench, Rates& rates) {
    const MediumProfile medium =
        make_medium_profile(*bench.scene.materials[0].medium, 0, one_thread());
    measure_samples(bench, medium, rates);
    measure_truth(bench, medium, rates);
}

}  // namespace opaline::bake
