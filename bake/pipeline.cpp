#include "bake/pipeline.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/direct/bake_direct.h"
#include "bake/encode/pack_asset.h"
#include "bake/encode/provenance.h"
#include "bake/encode/select_coefficients.h"
#include "bake/measure/check_direct.h"
#include "bake/measure/check_translucent.h"
#include "bake/measure/thin_parts.h"
#include "bake/plan/plan_rules.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/orient_bodies.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/specular/bake_openness.h"
#include "bake/translucent/translucent_rows.h"
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

// Receivers whose material has no diffuse row gather nothing.
void leave_out_skipped(const formats::Scene& scene, std::span<const RowLayout> layouts,
                       std::vector<Receiver>& receivers) {
    std::size_t v = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.position.size(); ++i, ++v) {
            if (!layouts[p.material].direct) {
                receivers[v].normal = glm::vec3(0);
            }
        }
    }
}

// The stages that the receivers of one medium share, and the recipe that uses them.
struct MediumStages {
    std::optional<MultipleStage> multiple;
    std::optional<SingleStage> single;
    TranslucentRecipe recipe;
};

using MediaStages = std::map<std::uint32_t, MediumStages>;  // by material

void prepare_media(const formats::Scene& scene, const RayScene& rays,
                   std::span<const RowLayout> layouts, const Knobs& knobs,
                   std::span<const TestLight> lights, const Context& context, BakeResult& result,
                   MediaStages& media) {
    std::vector<std::span<const float>> vectors;
    for (const TestLight& light : lights) {
        vectors.push_back(light.coarse);
    }
    for (std::uint32_t m = 0; m < layouts.size(); ++m) {
        const RowLayout& layout = layouts[m];
        if (!layout.translucent) {
            continue;
        }
        MediumStages& stages = media[m];
        const std::string of = " of material '" + scene.materials[m].name + "'";
        if (layout.multiple) {
            stages.multiple = run_stage(result, "samples" + of, [&](std::uint64_t& traced) {
                const std::uint32_t kept = std::min(knobs.coefficients, 4096u);
                MultipleStage stage =
                    prepare_multiple(scene, rays, m,
                                     {knobs.cubemap_size, knobs.samples, knobs.exact_samples, kept,
                                      knobs.seed, !knobs.exact_rays},
                                     vectors, context);
                traced = stage.transport.rays;
                return stage;
            });
        }
        if (layout.single_terms > 0) {
            stages.single = run_stage(result, "light maps" + of, [&](std::uint64_t&) {
                return prepare_single(scene, rays, m,
                                      {knobs.single_cubemap, knobs.depth_samples,
                                       layout.single_terms, knobs.exact_rays},
                                      context);
            });
        }
        stages.recipe = {layout,
                         stages.multiple ? &*stages.multiple : nullptr,
                         stages.single ? &*stages.single : nullptr,
                         {knobs.tolerance},
                         make_selector(knobs.cubemap_size, knobs.coefficients),
                         knobs.code_bits};
    }
}

// The rows of all primitives, in their order; one stage of the report for each primitive.
formats::Result<formats::SparseRows> bake_rows(const formats::Scene& scene, const RayScene& rays,
                                               std::span<const Receiver> receivers,
                                               std::span<const BodyPoint> points,
                                               std::span<const RowLayout> layouts,
                                               const MediaStages& media, const Knobs& knobs,
                                               const Context& context, BakeResult& result) {
    const DirectionSet directions = make_direction_set(knobs.cubemap_size);
    const Selector selector = make_selector(knobs.cubemap_size, knobs.coefficients);
    formats::SparseRows rows = formats::make_sparse_rows(knobs.cubemap_size, knobs.code_bits);
    std::size_t first = 0;
    for (const formats::Primitive& primitive : scene.primitives) {
        const std::size_t count = primitive.position.size();
        const auto medium = media.find(primitive.material);
        const formats::SparseRows part =
            run_stage(result, "rows of '" + primitive.name + "'", [&](std::uint64_t& traced) {
                if (medium == media.end()) {
                    return bake_direct(rays, directions, selector, knobs.code_bits,
                                       receivers.subspan(first, count), {first, receivers.size()},
                                       context, traced);
                }
                EntryCounts counts;
                formats::SparseRows baked = bake_translucent(
                    medium->second.recipe, rays, points.subspan(first, count), context, counts);
                traced = counts.rays;
                return baked;
            });
        if (context.cancelled()) {
            break;
        }
        const std::size_t terms = layouts[primitive.material].terms();
        if (part.row_offset.size() != terms * count + 1 || !formats::append_rows(rows, part)) {
            return make_error(ErrorKind::resource, "", "transport",
                              "more than 2^32 coefficients do not fit into one file",
                              "lower --coefficients, or split the scene");
        }
        first += count;
    }
    return rows;
}

// Of all vertices; empty where nothing is glossy.
std::vector<formats::Openness> bake_all_openness(const formats::Scene& scene, const RayScene& rays,
                                                 std::span<const RowLayout> layouts,
                                                 const Context& context, BakeResult& result) {
    std::vector<formats::Openness> openness;
    if (std::none_of(layouts.begin(), layouts.end(), [](const RowLayout& l) { return l.glossy; })) {
        return openness;
    }
    return run_stage(result, "openness", [&](std::uint64_t& traced) {
        const DirectionSet directions = make_sparse_direction_set(kOpennessCubemap, 0);
        const std::vector<Receiver> all =
            take_over_hidden(rays, scene, make_vertex_receivers(scene));
        const std::span<const Receiver> receivers = all;
        std::size_t first = 0;
        for (const formats::Primitive& primitive : scene.primitives) {
            const std::size_t count = primitive.position.size();
            if (layouts[primitive.material].glossy) {
                const auto part = bake_openness(rays, directions, receivers.subspan(first, count),
                                                context, traced);
                openness.insert(openness.end(), part.begin(), part.end());
            }
            first += count;
            openness.resize(first);
        }
        return std::move(openness);
    });
}

ErrorReport check_rows(const formats::Scene& scene, const RayScene& rays,
                       std::span<const Receiver> receivers, std::span<const BodyPoint> points,
                       const MediaStages& media, const Knobs& knobs,
                       std::span<const TestLight> lights, const formats::AssetView& asset,
                       const Context& context, std::uint64_t& traced) {
    const std::vector<std::uint32_t> drawn = draw_receivers(receivers.size(), knobs.seed);
    std::vector<EffectCheck> checks{check_direct(rays, receivers, asset, drawn, lights, context)};
    for (const auto& [m, stages] : media) {
        if (!stages.multiple && !stages.single) {
            continue;  // black: nothing to be wrong
        }
        checks.push_back(check_translucent(stages.recipe, scene, rays, m, knobs.depth_samples,
                                           points, asset, drawn, lights, context));
    }
    std::vector<std::string> names;
    for (const TestLight& light : lights) {
        names.push_back(light.name);
    }
    for (const EffectCheck& check : checks) {
        traced += check.rays;
    }
    return summarise_checks(checks, names, knobs.seed);
}

// Says where the dipole's half space is far from the truth.
void warn_of_thin_parts(const formats::Scene& scene, const RayScene& rays,
                        std::span<const BodyPoint> points, const MediaStages& media,
                        std::uint64_t seed, std::vector<formats::Diagnostic>& warnings) {
    constexpr double kWorthSaying = 0.1;
    const std::vector<std::uint32_t> drawn = draw_receivers(points.size(), seed);
    for (const auto& [m, stages] : media) {
        if (!stages.multiple) {
            continue;
        }
        const double excess = estimate_thin_excess(stages.multiple->medium, rays, m, points, drawn);
        if (excess > kWorthSaying) {
            warnings.push_back(formats::make_warning(
                "", "material '" + scene.materials[m].name + "'",
                "light crosses the body: diffusion takes it for a half space and makes it up to " +
                    std::to_string(static_cast<int>(100 * excess + 0.5)) +
                    " % too bright under even light",
                "compare with `opaline reference`; denser media and thicker bodies err less"));
        }
    }
}

formats::Error interrupted() {
    return make_error(ErrorKind::interrupted, "", "", "interrupted", "nothing was written");
}

}  // namespace

formats::Result<BakeResult> run_bake(const formats::Scene& given, const Knobs& knobs,
                                     const Context& outer) {
    const Clock::time_point start = Clock::now();
    Context context = outer;
    context.threads = thread_count(outer);
    BakeResult result;
    result.knobs = knobs;
    result.threads = context.threads;

    const OrientedBodies bodies =
        run_stage(result, "bodies", [&](std::uint64_t&) { return orient_bodies(given); });
    const formats::Scene& scene = bodies.scene ? *bodies.scene : given;
    result.warnings = describe_faults(given, bodies.surfaces);

    result.plan = run_stage(
        result, "plan", [&](std::uint64_t&) { return plan_bake(scene, knobs, context.threads); });
    formats::Result<RayScene> rays = run_stage(result, "hierarchy", [&](std::uint64_t&) {
        return RayScene::build(scene, context.threads);
    });
    if (!rays) {
        return std::move(rays).error();
    }
    std::vector<RowLayout> layouts = layout_rows(scene, result.plan, knobs);
    for (std::size_t m = 0; m < layouts.size(); ++m) {
        if (layouts[m].direct && scene.materials[m].medium) {
            layouts[m].tint = half_space_albedo(*scene.materials[m].medium, knobs.seed, context);
        }
    }
    std::vector<BodyPoint> points;
    const std::vector<Receiver> receivers = run_stage(result, "receivers", [&](std::uint64_t&) {
        std::vector<Receiver> all = make_vertex_receivers(scene);
        points = make_body_points(scene, all);
        leave_out_skipped(scene, layouts, all);
        return take_over_hidden(*rays, scene, std::move(all));
    });
    formats::Result<std::vector<TestLight>> lights = run_stage(
        result, "test lights",
        [&](std::uint64_t&) { return make_test_lights(knobs.cubemap_size, context.threads); });
    if (!lights) {
        return std::move(lights).error();
    }
    MediaStages media;
    prepare_media(scene, *rays, layouts, knobs, *lights, context, result, media);
    if (context.cancelled()) {
        return interrupted();
    }
    formats::Result<formats::SparseRows> rows =
        bake_rows(scene, *rays, receivers, points, layouts, media, knobs, context, result);
    if (context.cancelled()) {
        return interrupted();
    }
    if (!rows) {
        return std::move(rows).error();
    }
    warn_of_thin_parts(scene, *rays, points, media, knobs.seed, result.warnings);
    std::vector<formats::Openness> openness =
        bake_all_openness(scene, *rays, layouts, context, result);
    if (context.cancelled()) {
        return interrupted();
    }
    result.asset = pack_asset(scene, layouts, std::move(*rows), std::move(openness));
    result.error = run_stage(result, "self-check", [&](std::uint64_t& traced) {
        return check_rows(scene, *rays, receivers, points, media, knobs, *lights,
                          result.asset.view(), context, traced);
    });
    if (context.cancelled()) {
        return interrupted();
    }
    if (knobs.check_model) {
        ModelCheckOptions options;
        options.seed = knobs.seed;
        auto checked = run_stage(result, "model check", [&](std::uint64_t&) {
            return check_model(scene, result.asset.view(), options, context);
        });
        if (!checked) {
            return std::move(checked).error();
        }
        result.model_error = std::move(*checked);
    }
    result.asset.provenance = make_provenance(scene, knobs, result.plan, result.error,
                                              result.model_error, RayScene::description());
    result.seconds_total = seconds_since(start);
    return result;
}

}  // namespace opaline::bake
