#include "bake/effects/single/single_rates.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "bake/calibration/bench/stopwatch.h"
#include "bake/effects/single/gather_direction.h"
#include "bake/effects/single/light_maps.h"
#include "bake/effects/single/single_stage.h"
#include "bake/effects/single/texel_directions.h"
#include "bake/effects/single/true_single.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

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

// Seconds per direction.
double measure_directions(const CalibrationBench& bench, const BodyMesh& mesh,
                          const SingleMedium& medium, const NodeList& list, std::uint32_t pixels) {
    const DirectionSet texels = make_texel_directions(16);
    const GatherJob job = make_gather_job(bench.rays, mesh, pixels, medium, list);
    GatherWorkspace work;
    work.value.assign(3 * job.terms * bench.points.size(), 0.0f);
    constexpr std::size_t kDirections = 3;
    double seconds = 0;
    for (std::size_t i = 0; i <= kDirections; ++i) {
        const DirectionBlock& block = texels.blocks[i * (texels.blocks.size() - 1) / kDirections];
        const glm::vec3 w{block.dir_x[5], block.dir_y[5], block.dir_z[5]};
        const Stopwatch once;
        gather_direction(job, {w, 1}, {0.3f, 0.6f}, work);
        seconds += i == 0 ? 0 : once.seconds();  // the first run allocates the memory
    }
    return seconds / kDirections;
}

void measure_light_maps(const CalibrationBench& bench, Rates& rates) {
    const Context context = one_thread();
    Stopwatch watch;
    const BodyMesh mesh = make_body_mesh(bench.scene, bench.rays, 0, context);
    bench.side_of(rates.body_triangle) = watch.seconds() / bench.triangles;
    const std::uint32_t size = light_view_size(mesh);
    const std::vector<BodyPoint> points = bench.neighbours_together();
    const SingleMedium isotropic = make_single_medium(bench.scene, 0, 6);
    watch.restart();
    const NodeList list = collect_nodes(bench.rays, isotropic, mesh.centre, points, context);
    bench.side_of(rates.place_nodes) = watch.seconds() / static_cast<double>(points.size());
    NodeList none;
    none.throughput = list.throughput;
    const auto nodes = static_cast<double>(list.node.size());
    const double view = measure_directions(bench, mesh, isotropic, none, size);
    const double full = measure_directions(bench, mesh, isotropic, list, size);
    const double looked = std::max(0.0, full - view) / nodes;
    bench.side_of(rates.look_up) = looked;
    if (!bench.is_many) {
        return;
    }
    const double wide = measure_directions(bench, mesh, isotropic, none, 2 * size);
    const double pixels = 3.0 * size * size;
    rates.draw_pixel = std::max(0.0, wide - view) / pixels;
    rates.draw_triangle = std::max(0.0, view - pixels / 3 * rates.draw_pixel) / bench.triangles;
    PhaseTerms four;
    four.lambda = {1.0f, 0.5f};
    const SingleMedium forward = make_single_medium(bench.scene, 0, 6, four);
    const double with_four =
        std::max(0.0, measure_directions(bench, mesh, forward, list, size) - view) / nodes;
    rates.look_up_term = std::max(0.0, with_four - looked) / 3;
    rates.unpack_texel = measure_unpacking();
}

void measure_truth(const CalibrationBench& bench, Rates& rates) {
    const SingleQuadrature quadrature = make_single_quadrature(bench.scene, 0, 4, bench.lights);
    double seconds = 0, packets = 0;
    std::uint64_t traced = 0;
    for (const BodyPoint& point : thinned(std::span<const BodyPoint>(bench.points), 8)) {
        const Stopwatch watch;
        integrate_single(quadrature, bench.rays, point, traced);
        seconds += watch.seconds();
        packets += 4.0 * static_cast<double>(quadrature.directions.blocks.size() +
                                             quadrature.suns.packets.size());
    }
    bench.side_of(rates.entry_packet) = seconds / packets;
}

}  // namespace

void calibrate_single(const CalibrationBench& bench, Rates& rates) {
    measure_light_maps(bench, rates);
    measure_truth(bench, rates);
}

}  // namespace opaline::bake
