#include "bake/pipeline.h"

#include <sys/resource.h>

#include <chrono>
#include <cmath>
#include <map>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/direct/bake_direct.h"
#include "bake/encode/pack_asset.h"
#include "bake/encode/provenance.h"
#include "bake/encode/select_coefficients.h"
#include "bake/measure/check_direct.h"
#include "bake/measure/check_multiple.h"
#include "bake/multiple/bake_multiple.h"
#include "bake/receivers/surface_samples.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/visibility/hidden_receivers.h"
#include "bake/visibility/irradiance_transport.h"

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
        const bool on = is_planned(plan, "direct", material_subject(scene.materials[p.material]));
        for (std::size_t i = 0; i < p.position.size(); ++i, ++v) {
            receivers[v].normal = on ? receivers[v].normal : glm::vec3(0);
        }
    }
}

// What the gather inside one medium needs.
struct MediumStage {
    double exit = 1;  // c_exit
    GatherProfile profile;
    SampleTransport transport;
    ClusterTree tree;
};

double scene_diagonal(const formats::Scene& scene) {
    glm::dvec3 low(HUGE_VAL), high(-HUGE_VAL);
    for (const formats::Primitive& p : scene.primitives) {
        for (const glm::vec3 x : p.position) {
            low = glm::min(low, glm::dvec3(x));
            high = glm::max(high, glm::dvec3(x));
        }
    }
    return glm::length(high - low);
}

// Everything that the vertices of a material share. Where the effect is off the tree is empty and
// every vertex gathers nothing.
MediumStage prepare_medium(const formats::Scene& scene, std::uint32_t material, bool on,
                           const RayScene& rays, const Knobs& knobs,
                           std::span<const TestLight> lights, const Context& context) {
    MediumStage stage;
    if (!on) {
        return stage;
    }
    const formats::Medium& medium = *scene.materials[material].medium;
    std::vector<std::uint32_t> primitives;
    double area = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        if (scene.primitives[p].material == material) {
            primitives.push_back(p);
            area += formats::surface_area(scene.primitives[p]);
        }
    }
    const MediumProfile profile = make_medium_profile(medium, knobs.seed, context);
    const std::vector<SurfaceSample> samples =
        sample_surface(scene, primitives, count_samples(area, profile, knobs.samples), knobs.seed);
    const double spacing =
        std::sqrt(area / static_cast<double>(std::max<std::size_t>(1, samples.size())));
    stage.exit = profile.exit;
    stage.profile = make_gather_profile(profile, spacing, scene_diagonal(scene));
    std::vector<std::span<const float>> vectors;
    for (const TestLight& light : lights) {
        vectors.push_back(light.coarse);
    }
    const std::uint32_t kept = std::min(knobs.coefficients, 4096u);
    stage.transport = bake_sample_transport(rays, samples, {knobs.cubemap_size, kept, profile.eta},
                                            vectors, context);
    if (!context.cancelled()) {
        stage.tree = build_cluster_tree(samples, stage.transport, knobs.cubemap_size,
                                        std::min(2 * kept, 4096u), context);
    }
    return stage;
}

using MediumStages = std::map<std::uint32_t, MediumStage>;  // by material

// The rows of all primitives, in their order.
formats::Result<formats::SparseRows> bake_rows(const formats::Scene& scene, const RayScene& rays,
                                               std::span<const Receiver> receivers,
                                               const MediumStages& media, const Knobs& knobs,
                                               const Context& context, std::uint64_t& traced) {
    const DirectionSet directions = make_direction_set(knobs.cubemap_size);
    const Selector selector = make_selector(knobs.cubemap_size, knobs.coefficients);
    formats::SparseRows rows = formats::make_sparse_rows(knobs.cubemap_size, knobs.code_bits);
    std::size_t first = 0;
    for (const formats::Primitive& primitive : scene.primitives) {
        const std::size_t count = primitive.position.size();
        const auto medium = media.find(primitive.material);
        const formats::SparseRows part =
            medium == media.end()
                ? bake_direct(rays, directions, selector, knobs.code_bits,
                              receivers.subspan(first, count), {first, receivers.size()}, context,
                              traced)
                : bake_multiple(medium->second.tree, medium->second.profile, medium->second.exit,
                                {knobs.tolerance}, selector, knobs.code_bits, primitive, context);
        if (context.cancelled()) {
            break;
        }
        if (part.row_offset.size() != count + 1 || !formats::append_rows(rows, part)) {
            return make_error(ErrorKind::resource, "", "transport",
                              "more than 2^32 coefficients do not fit into one file",
                              "lower --coefficients, or split the scene");
        }
        first += count;
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
    formats::Result<std::vector<TestLight>> lights = run_stage(
        result, "test lights",
        [&](std::uint64_t&) { return make_test_lights(knobs->cubemap_size, context.threads); });
    if (!lights) {
        return std::move(lights).error();
    }
    MediumStages media;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        const formats::Material& material = scene.materials[m];
        if (material.medium) {
            const std::string subject = material_subject(material);
            media[m] = run_stage(result, "medium of " + subject, [&](std::uint64_t& traced) {
                MediumStage stage =
                    prepare_medium(scene, m, is_planned(result.plan, "multiple", subject), *rays,
                                   *knobs, *lights, context);
                traced = stage.transport.rays;
                return stage;
            });
        }
    }
    formats::Result<formats::SparseRows> rows =
        run_stage(result, "receivers' rows", [&](std::uint64_t& traced) {
            return bake_rows(scene, *rays, receivers, media, *knobs, context, traced);
        });
    if (context.cancelled()) {
        return interrupted();
    }
    if (!rows) {
        return std::move(rows).error();
    }
    result.asset = pack_asset(scene, std::move(*rows));
    result.error = run_stage(result, "self-check", [&](std::uint64_t& traced) {
        const formats::AssetView asset = result.asset.view();
        const std::vector<std::uint32_t> drawn = draw_receivers(receivers.size(), knobs->seed);
        std::vector<EffectCheck> checks{
            check_direct(*rays, receivers, asset, drawn, *lights, context)};
        for (const auto& [m, stage] : media) {
            checks.push_back(check_multiple(stage.tree, stage.profile, stage.exit, stage.transport,
                                            m, asset, drawn, *lights, context));
        }
        traced = checks.front().rays;
        std::vector<std::string> names;
        for (const TestLight& light : *lights) {
            names.push_back(light.name);
        }
        return summarise_checks(checks, names, knobs->seed);
    });
    if (context.cancelled()) {
        return interrupted();
    }
    result.asset.provenance = make_provenance(scene, options.quality, *knobs, result.plan,
                                              result.error, RayScene::description());
    result.seconds_total = seconds_since(start);
    return result;
}

}  // namespace opaline::bake
