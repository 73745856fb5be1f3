#include "bake/pipeline.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/choose_knobs.h"
#include "bake/direct/bake_direct.h"
#include "bake/encode/pack_asset.h"
#include "bake/encode/provenance.h"
#include "bake/encode/select_coefficients.h"
#include "bake/measure/check_direct.h"
#include "bake/measure/check_translucent.h"
#include "bake/measure/thin_parts.h"
#include "bake/plan/inspect_scene.h"
#include "bake/plan/plan_rules.h"
#include "bake/plan/row_layout.h"
#include "bake/prepare_media.h"
#include "bake/receivers/orient_bodies.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/run_stage.h"
#include "bake/specular/bake_openness.h"
#include "bake/translucent/translucent_rows.h"
#include "bake/visibility/hidden_receivers.h"
#include "bake/visibility/irradiance_transport.h"

namespace opaline::bake {
namespace {

using formats::ErrorKind;
using formats::make_error;

// Media that are shown as diffuse surfaces, for comparison.
bool is_opaque_medium(const formats::Scene& scene, std::span<const RowLayout> layouts,
                      std::size_t m) {
    return layouts[m].direct && scene.materials[m].medium.has_value();
}

bool has_opaque_media(const formats::Scene& scene, std::span<const RowLayout> layouts) {
    for (std::size_t m = 0; m < layouts.size(); ++m) {
        if (is_opaque_medium(scene, layouts, m)) {
            return true;
        }
    }
    return false;
}

std::vector<RowLayout> tint_media(const formats::Scene& scene, std::uint64_t seed,
                                  const Context& context, std::vector<RowLayout> layouts) {
    for (std::size_t m = 0; m < layouts.size(); ++m) {
        if (is_opaque_medium(scene, layouts, m)) {
            layouts[m].tint = half_space_albedo(*scene.materials[m].medium, seed, context);
        }
    }
    return layouts;
}

// Receivers whose material has no diffuse row gather nothing.
std::vector<Receiver> leave_out_skipped(const formats::Scene& scene,
                                        std::span<const RowLayout> layouts,
                                        std::vector<Receiver> receivers) {
    std::size_t v = 0;
    for (const formats::Primitive& p : scene.primitives) {
        for (std::size_t i = 0; i < p.position.size(); ++i, ++v) {
            if (!layouts[p.material].direct) {
                receivers[v].normal = glm::vec3(0);
            }
        }
    }
    return receivers;
}

// The rows of all primitives, in their order; one stage of the report for each primitive.
formats::Result<formats::SparseRows> bake_rows(const PilotScene& all, const MediaStages& media,
                                               const Knobs& knobs, const Context& context,
                                               BakeResult& result) {
    const DirectionSet directions = make_direction_set(knobs.cubemap_size);
    const Selector selector = make_selector(knobs.cubemap_size, knobs.coefficients);
    formats::SparseRows rows = formats::make_sparse_rows(knobs.cubemap_size, knobs.code_bits);
    std::size_t first = 0;
    for (const formats::Primitive& primitive : all.scene.primitives) {
        const std::size_t count = primitive.position.size();
        const auto medium = media.find(primitive.material);
        const formats::SparseRows part =
            run_stage(result, "rows of '" + primitive.name + "'", [&](std::uint64_t& traced) {
                if (medium == media.end()) {
                    return bake_direct(all.rays_of(primitive.material), directions, selector,
                                       knobs.code_bits, all.receivers.subspan(first, count),
                                       {first, all.receivers.size()}, context, traced);
                }
                EntryCounts counts;
                formats::SparseRows baked =
                    bake_translucent(medium->second.recipe, all.rays_of(primitive.material),
                                     all.vertices.subspan(first, count),
                                     all.points.subspan(first, count), context, counts);
                traced = counts.rays;
                return baked;
            });
        if (context.cancelled()) {
            break;
        }
        const std::size_t terms = all.layouts[primitive.material].terms();
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
std::vector<formats::Openness> bake_all_openness(const PilotScene& all, const Context& context,
                                                 BakeResult& result) {
    std::vector<formats::Openness> openness;
    if (std::none_of(all.layouts.begin(), all.layouts.end(),
                     [](const RowLayout& l) { return l.glossy; })) {
        return openness;
    }
    return run_stage(result, "openness", [&](std::uint64_t& traced) {
        const DirectionSet directions = make_sparse_direction_set(kOpennessCubemap, 0);
        const std::span<const Receiver> receivers = all.vertices;
        std::size_t first = 0;
        for (const formats::Primitive& primitive : all.scene.primitives) {
            const std::size_t count = primitive.position.size();
            if (all.layouts[primitive.material].glossy) {
                const auto part = bake_openness(all.rays_of(primitive.material), directions,
                                                receivers.subspan(first, count), context, traced);
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
        if (!stages.multiple && !stages.single && !stages.local) {
            continue;  // black: nothing to be wrong
        }
        checks.push_back(check_translucent(stages.recipe, scene, rays, m, knobs.depth_samples,
                                           points, asset, drawn, lights, knobs.seed, context));
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

formats::Result<BakeResult> run_bake(const formats::Scene& given, const Knobs& wanted,
                                     const Context& outer) {
    const Clock::time_point start = Clock::now();
    Context context = outer;
    context.threads = thread_count(outer);
    BakeResult result;
    result.knobs = wanted;
    Knobs& knobs = result.knobs;
    result.threads = context.threads;

    const OrientedBodies bodies =
        run_stage(result, "bodies", [&](std::uint64_t&) { return orient_bodies(given); });
    const formats::Scene& scene = bodies.scene ? *bodies.scene : given;
    result.warnings = describe_faults(given, bodies.surfaces);

    SceneFacts facts;
    result.plan = run_stage(result, "plan", [&](std::uint64_t&) {
        facts = inspect_scene(scene);
        return plan_bake(scene, facts, knobs);
    });
    std::vector<RowLayout> layouts = layout_rows(scene, result.plan, knobs);
    formats::Result<RayScene> sky = RayScene::build({}, context.threads);
    if (!sky) {
        return std::move(sky).error();
    }
    std::optional<RayScene> hierarchy;
    if (needs_hierarchy(layouts)) {
        formats::Result<RayScene> built = run_stage(result, "hierarchy", [&](std::uint64_t&) {
            return RayScene::build(scene, context.threads);
        });
        if (!built) {
            return std::move(built).error();
        }
        hierarchy = std::move(*built);
    }
    const RayScene& rays = hierarchy ? *hierarchy : *sky;
    if (has_opaque_media(scene, layouts)) {
        layouts = run_stage(result, "albedos of media", [&](std::uint64_t&) {
            return tint_media(scene, knobs.seed, context, std::move(layouts));
        });
    }
    std::vector<BodyPoint> points;
    const std::vector<Receiver> vertices = run_stage(result, "receivers", [&](std::uint64_t&) {
        std::vector<Receiver> all = make_vertex_receivers(scene);
        points = make_body_points(scene, all);
        return take_over_hidden(rays, scene, std::move(all), context);
    });
    const std::vector<Receiver> receivers = leave_out_skipped(scene, layouts, vertices);
    formats::Result<std::vector<TestLight>> lights =
        run_stage(result, "test lights", [&](std::uint64_t&) {
            return make_test_lights(
                knobs.cubemap_size, context.threads,
                context.cache.empty() ? context.cache : context.cache / "test-lights");
        });
    if (!lights) {
        return std::move(lights).error();
    }
    const MediaProfiles profiles = run_stage(result, "profiles", [&](std::uint64_t&) {
        return make_profiles(scene, layouts, knobs.seed, context);
    });
    const PilotScene pilot{scene, rays, *sky, receivers, vertices, points, layouts, profiles};
    MediaStages media = knobs.error_target > 0 ? choose_knobs(pilot, *lights, context, result)
                                               : prepare_media(pilot, knobs, context, result);
    finish_media(pilot, knobs, context, result, media);
    if (knobs.error_target > 0) {
        result.plan = plan_bake(scene, facts, knobs);  // of the knobs that were chosen
    }
    if (context.cancelled()) {
        return interrupted();
    }
    formats::Result<formats::SparseRows> rows = bake_rows(pilot, media, knobs, context, result);
    if (context.cancelled()) {
        return interrupted();
    }
    if (!rows) {
        return std::move(rows).error();
    }
    warn_of_thin_parts(scene, rays, points, media, knobs.seed, result.warnings);
    std::vector<formats::Openness> openness = bake_all_openness(pilot, context, result);
    if (context.cancelled()) {
        return interrupted();
    }
    result.asset = pack_asset(scene, layouts, std::move(*rows), std::move(openness));
    result.error = run_stage(result, "self-check", [&](std::uint64_t& traced) {
        return check_rows(scene, rays, receivers, points, media, knobs, *lights,
                          result.asset.view(), context, traced);
    });
    if (context.cancelled()) {
        return interrupted();
    }
    if (result.accuracy) {
        warn_of_missed_target(result, result.warnings);
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
