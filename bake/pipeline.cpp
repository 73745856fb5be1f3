#include "bake/pipeline.h"

#include <sys/resource.h>

#include <chrono>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/encode/pack_asset.h"
#include "bake/encode/provenance.h"
#include "bake/encode/select_coefficients.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/visibility/hidden_receivers.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

std::uint64_t peak_rss_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

// Times one stage and notes it in the report when it ends.
template <class Stage>
auto run_stage(BakeResult& result, std::string name, Stage&& stage) {
    const Clock::time_point start = Clock::now();
    std::uint64_t rays = 0;
    auto value = stage(rays);
    result.stages.push_back({std::move(name), seconds_since(start), rays, peak_rss_bytes()});
    return value;
}

// Receivers of materials for which the effect is off gather nothing.
void leave_out_skipped(const formats::Scene& scene, const std::vector<PlanEntry>& plan,
                       std::vector<Receiver>& receivers) {
    std::size_t v = 0;
    for (const formats::Primitive& p : scene.primitives) {
        const std::string subject = material_subject(scene.materials[p.material]);
        bool on = false;
        for (const PlanEntry& entry : plan) {
            on = on || (entry.effect == "direct" && entry.subject == subject && entry.on);
        }
        for (std::size_t i = 0; i < p.position.size(); ++i, ++v) {
            receivers[v].normal = on ? receivers[v].normal : glm::vec3(0);
        }
    }
}

struct Block {
    formats::SparseRows rows;
    std::uint64_t rays = 0;
};

// Transport of a diffuse surface, T = V max(0, n.w) / pi, one receiver at a time: dense, Haar,
// selection, quantisation. Only one dense vector per thread exists at any time.
Block bake_block(const RayScene& rays, const DirectionSet& directions, const Selector& selector,
                 std::span<const Receiver> receivers, std::uint32_t code_bits) {
    Block block{formats::make_sparse_rows(directions.cubemap_size, code_bits), 0};
    std::vector<float> dense(selector.weight.size());
    for (const Receiver& receiver : receivers) {
        block.rays += gather_irradiance(rays, directions, receiver, dense);
        for (float& value : dense) {
            value *= std::numbers::inv_pi_v<float>;
        }
        formats::haar_forward_cube(std::span<float>(dense), directions.cubemap_size);
        formats::append_row(block.rows, select_coefficients(selector, dense, 1));
    }
    return block;
}

formats::Result<formats::SparseRows> bake_direct(const RayScene& rays, const Knobs& knobs,
                                                 std::span<const Receiver> receivers,
                                                 const Context& context, std::uint64_t& traced) {
    constexpr std::size_t kReceiversPerBlock = 64;
    const DirectionSet directions = make_direction_set(knobs.cubemap_size);
    const Selector selector = make_selector(knobs.cubemap_size, knobs.coefficients);
    formats::SparseRows rows = formats::make_sparse_rows(knobs.cubemap_size, knobs.code_bits);
    bool fits = true;
    for_each_block_in_order(
        receivers.size(), kReceiversPerBlock, context,
        [&](Range range) {
            return bake_block(rays, directions, selector,
                              receivers.subspan(range.begin, range.end - range.begin),
                              knobs.code_bits);
        },
        [&](Range range, Block block) {
            fits = fits && formats::append_rows(rows, block.rows);
            traced += block.rays;
            if (context.on_progress) {
                context.on_progress({"direct", range.end, receivers.size()});
            }
        });
    if (!fits) {
        return make_error(ErrorKind::resource, "", "transport",
                          "more than 2^32 coefficients do not fit into one file",
                          "lower --coefficients, or split the scene");
    }
    return rows;
}

formats::Error interrupted() {
    return make_error(ErrorKind::interrupted, "", "", "interrupted", "nothing was written");
}

}  // namespace

formats::Result<BakeResult> run_bake(const formats::Scene& scene, const BakeOptions& options,
                                     const Context& outer) {
    const Clock::time_point start = Clock::now();
    formats::Result<Knobs> knobs = resolve_knobs(options);
    if (!knobs) {
        return std::move(knobs).error();
    }
    Context context = outer;
    context.threads = thread_count(outer);
    BakeResult result;
    result.knobs = *knobs;
    result.threads = context.threads;

    result.plan = run_stage(
        result, "plan", [&](std::uint64_t&) { return plan_bake(scene, *knobs, context.threads); });
    formats::Result<RayScene> rays = run_stage(result, "hierarchy", [&](std::uint64_t&) {
        return RayScene::build(scene, context.threads);
    });
    if (!rays) {
        return std::move(rays).error();
    }
    const std::vector<Receiver> receivers = run_stage(result, "receivers", [&](std::uint64_t&) {
        std::vector<Receiver> all = make_vertex_receivers(scene);
        leave_out_skipped(scene, result.plan, all);
        return take_over_hidden(*rays, scene, std::move(all));
    });
    formats::Result<formats::SparseRows> rows =
        run_stage(result, "direct", [&](std::uint64_t& traced) {
            return bake_direct(*rays, *knobs, receivers, context, traced);
        });
    if (context.cancelled()) {
        return interrupted();
    }
    if (!rows) {
        return std::move(rows).error();
    }
    formats::Result<std::vector<TestLight>> lights = run_stage(
        result, "test lights",
        [&](std::uint64_t&) { return make_test_lights(knobs->cubemap_size, context.threads); });
    if (!lights) {
        return std::move(lights).error();
    }
    result.error = run_stage(result, "self-check", [&](std::uint64_t& traced) {
        ErrorReport report =
            measure_direct_error(*rays, receivers, rows->view(), *lights, knobs->seed, context);
        traced = report.rays;
        return report;
    });
    if (context.cancelled()) {
        return interrupted();
    }
    result.asset = pack_asset(scene, std::move(*rows));
    result.asset.provenance = make_provenance(scene, options.quality, *knobs, result.plan,
                                              result.error, RayScene::description());
    result.seconds_total = seconds_since(start);
    return result;
}

}  // namespace opaline::bake
