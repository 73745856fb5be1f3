#include "bake/calibration/calibrate_media.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "bake/calibration/stopwatch.h"
#include "bake/effects/multiple/gather_multiple.h"
#include "bake/effects/multiple/true_multiple.h"
#include "bake/effects/single/gather_direction.h"
#include "bake/effects/single/light_maps.h"
#include "bake/effects/single/single.h"
#include "bake/effects/single/texel_directions.h"
#include "bake/effects/single/true_single.h"
#include "bake/receivers/spatial_order.h"
#include "bake/receivers/surface_samples.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

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

// The cube map is small, so that the sums take longer than their truncation.
double measure_sum_entry(const CalibrationBench& bench, std::span<const SurfaceSample> samples,
                         double truncate_texel) {
    constexpr std::uint32_t kSmall = 8;
    constexpr std::size_t kTraced = 256;
    static_assert(kTraced % SparseVectors::kPerBlock == 0);
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

// In the order of the stages, where neighbours read the same cache lines.
std::vector<BodyPoint> neighbours_together(std::span<const BodyPoint> points) {
    std::vector<glm::vec3> positions;
    for (const BodyPoint& point : points) {
        positions.push_back(point.position);
    }
    std::vector<BodyPoint> ordered;
    for (const std::uint32_t index : spatial_order(positions)) {
        ordered.push_back(points[index]);
    }
    return ordered;
}

// Reads one receiver's terms from the packed rows of many.
double measure_unpacking() {
    constexpr std::uint32_t kCoarse = 16, kTerms = 4;
    SingleBatch batch;
    const std::uint32_t texels = static_cast<std::uint32_t>(formats::cubemap_texels(kCoarse));
    constexpr std::uint32_t kReceivers = 64;
    batch.row_size = std::size_t{3} * kTerms * texels;
    PackedRows& packed = batch.rows.rows;
    packed.texels = texels;
    packed.largest_term.assign(kTerms, 1.0f);
    packed.scale.assign(kReceivers, 1.0f);
    packed.place.resize(kReceivers);
    std::iota(packed.place.begin(), packed.place.end(), 0u);
    std::uint16_t words[2];
    store_packed<3>(pack_values<3>({0.3f, 0.5f, 0.7f}, true), words);
    std::vector<std::uint16_t> texel;
    for (std::size_t i = 0; i < std::size_t{kReceivers} * kTerms; ++i) {
        texel.insert(texel.end(), {words[0], words[1]});
    }
    packed.packed.assign(texels, texel);
    std::vector<float> values(std::size_t{3} * kTerms *
                              formats::cubemap_texels(kCalibrationCubemap));
    const DenseRow row{values, kCalibrationCubemap, kTerms, 3};
    const Stopwatch watch;
    for (std::uint32_t r = 0; r < kReceivers; ++r) {
        std::fill(values.begin(), values.end(), 0.0f);
        add_single(batch, r, kCoarse, 0, row);
    }
    return watch.seconds() / (double{kReceivers} * kTerms * texels);
}

}  // namespace

void calibrate_multiple(const CalibrationBench& bench, bool is_many, Rates& rates) {
    constexpr std::uint32_t kSamples = 4096;
    constexpr std::size_t kTraced = 256;
    const double texels = static_cast<double>(formats::cubemap_texels(kCalibrationCubemap));
    const Context context = one_thread();
    Stopwatch watch;
    const std::vector<SurfaceSample> samples =
        sample_surface(bench.scene, {0}, kSamples, 0, context);
    rates.place_sample = watch.seconds() / static_cast<double>(samples.size());

    watch.restart();
    SampleTransport transport =
        bake_sample_transport(bench.rays, std::span(samples).first(kTraced),
                              {kCalibrationCubemap, kCalibrationKept, 1.3, true}, context);
    const double sample = watch.seconds() / kTraced;

    std::vector<float> dense(formats::cubemap_texels(kCalibrationCubemap));
    SparseVectors::Block vectors;
    constexpr int kVectors = 200;
    double truncate = 0;
    for (int i = 0; i < kVectors; ++i) {
        for (std::size_t k = 0; k < dense.size(); ++k) {
            dense[k] =
                static_cast<float>((k * 2654435761u + 97u * static_cast<unsigned>(i)) % 1021u);
        }
        watch.restart();
        append_truncated(vectors, dense, kCalibrationKept);
        truncate += watch.seconds();
    }
    rates.truncate_texel = truncate / (kVectors * texels);
    (is_many ? rates.shared_texel.many : rates.shared_texel.few) =
        std::max(0.0, sample / texels - rates.truncate_texel);
    if (!is_many) {
        return;
    }
    rates.sum_entry = measure_sum_entry(bench, samples, rates.truncate_texel);
    transport = repeated(transport, samples.size());
    const ClusterTree tree =
        build_cluster_tree(samples, transport, kCalibrationCubemap, kCalibrationKept, context);
    const MediumProfile medium = make_medium_profile(*bench.scene.materials[0].medium, 0, context);
    const double spacing = std::sqrt(tree.total_area / kSamples);
    const GatherProfile profile = make_gather_profile(medium, spacing, 4);
    std::vector<ClusterWeight> weights;
    std::vector<float> sums(4 * formats::cubemap_texels(kCalibrationCubemap));
    double collect = 0, gather = 0, taken = 0, gathered = 0;
    constexpr std::size_t kRuns = 5, kRun = 30;
    const std::vector<BodyPoint> points = neighbours_together(bench.points);
    for (std::size_t i = 0; i < std::min(kRuns * kRun, points.size()); ++i) {
        const BodyPoint& point =
            points[(i / kRun * (points.size() / kRuns) + i % kRun) % points.size()];
        watch.restart();
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

void calibrate_single(const CalibrationBench& bench, bool is_many, Rates& rates) {
    const Context context = one_thread();
    const auto pick = [is_many](CostBySize& cost) -> double& {
        return is_many ? cost.many : cost.few;
    };
    Stopwatch watch;
    const BodyMesh mesh = make_body_mesh(bench.scene, bench.rays, 0, context);
    pick(rates.body_triangle) = watch.seconds() / bench.triangles;
    const std::uint32_t size = light_view_size(mesh);
    const std::vector<BodyPoint> points = neighbours_together(bench.points);
    const DirectionSet texels = make_texel_directions(16);
    const auto time_directions = [&](const NodeList& list, const SingleMedium& medium,
                                     std::uint32_t pixels) {
        const GatherJob job = make_gather_job(bench.rays, mesh, pixels, medium, list);
        GatherWorkspace work;
        work.value.assign(3 * job.terms * points.size(), 0.0f);
        constexpr std::size_t kDirections = 3;
        double seconds = 0;
        for (std::size_t i = 0; i <= kDirections; ++i) {
            const DirectionBlock& block =
                texels.blocks[i * (texels.blocks.size() - 1) / kDirections];
            const glm::vec3 w{block.dir_x[5], block.dir_y[5], block.dir_z[5]};
            const Stopwatch once;
            gather_direction(job, {w, 1}, {0.3f, 0.6f}, work);
            seconds += i == 0 ? 0 : once.seconds();  // the first run allocates the memory
        }
        return seconds / kDirections;
    };
    const SingleMedium isotropic = make_single_medium(bench.scene, 0, 6);
    watch.restart();
    const NodeList list = collect_nodes(bench.rays, isotropic, mesh.centre, points, context);
    pick(rates.place_nodes) = watch.seconds() / static_cast<double>(points.size());
    NodeList none;
    none.throughput = list.throughput;
    const double view = time_directions(none, isotropic, size);
    const auto nodes = static_cast<double>(list.node.size());
    const double looked = std::max(0.0, time_directions(list, isotropic, size) - view) / nodes;
    pick(rates.look_up) = looked;
    if (is_many) {
        const double wide = time_directions(none, isotropic, 2 * size);
        const double pixels = 3.0 * size * size;
        rates.draw_pixel = std::max(0.0, wide - view) / pixels;
        rates.draw_triangle = std::max(0.0, view - pixels / 3 * rates.draw_pixel) / bench.triangles;
        PhaseTerms four;
        four.lambda = {1.0f, 0.5f};
        const SingleMedium forward = make_single_medium(bench.scene, 0, 6, four);
        const double with_four = std::max(0.0, time_directions(list, forward, size) - view) / nodes;
        rates.look_up_term = std::max(0.0, with_four - looked) / 3;
        rates.unpack_texel = measure_unpacking();
    }
}

void calibrate_check(const CalibrationBench& bench, bool is_many, std::span<const TestLight> lights,
                     Rates& rates) {
    const MediumProfile medium =
        make_medium_profile(*bench.scene.materials[0].medium, 0, one_thread());
    const SurfaceIntegral integral = make_surface_integral(bench.scene, 0, medium);
    const SingleQuadrature quadrature = make_single_quadrature(bench.scene, 0, 4, lights);
    const SunRays suns = make_sun_rays(lights, 4);
    const SmoothLights smooth = make_smooth_lights(lights);
    constexpr std::uint32_t kPoints = 256;
    double split = 0, point_rays = 0, single = 0, packets = 0;
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
        const Stopwatch watch;
        integrate_single(quadrature, bench.rays, points[i], traced);
        single += watch.seconds();
        packets += 4.0 * static_cast<double>(quadrature.directions.blocks.size() +
                                             quadrature.suns.packets.size());
    }
    const auto count = static_cast<double>(points.size());
    (is_many ? rates.entry_packet.many : rates.entry_packet.few) = single / packets;
    (is_many ? rates.surface_point.many : rates.surface_point.few) =
        point_rays / (count * 2 * kPoints);
    if (is_many) {
        rates.split_triangle = split / (count * bench.triangles);
    }
}

}  // namespace opaline::bake
