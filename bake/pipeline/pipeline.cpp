#include "bake/pipeline/pipeline.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>

#include "bake/accuracy/error_warnings.h"
#include "bake/accuracy/measure_error.h"
#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"
#include "bake/encode/pack_asset.h"
#include "bake/encode/row_sink.h"
#include "bake/pipeline/emitter_stages.h"
#include "bake/pipeline/filtered_textures.h"
#include "bake/pipeline/layer_stages.h"
#include "bake/pipeline/plan_scene.h"
#include "bake/pipeline/provenance.h"
#include "bake/pipeline/shared_light.h"
#include "bake/pipeline/volume_stages.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/rows/gather_rows.h"
#include "bake/rows/shared_batches.h"
#include "bake/scene/even_media.h"
#include "bake/scene/orient_bodies.h"
#include "bake/transport/bake_openness.h"
#include "bake/transport/hidden_receivers.h"
#include "bake/transport/touching_triangles.h"
#include "bake/volumes/place_nodes.h"
#include "bake/volumes/plan_volumes.h"
#include "bake/volumes/volume_effects.h"

namespace opaline::bake {
namespace {

std::vector<ReceiverSet> place_receivers(const formats::Scene& scene, const RayScene& rays,
                                         const Context& context) {
    std::vector<Receiver> vertices =
        leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), context);
    const std::vector<BodyPoint> inside = make_body_points(scene, vertices);
    return make_vertex_sets(
        scene, replace_hidden_receivers(rays, scene, std::move(vertices), context), inside);
}

// What the rows of a set are for, in the words of comparisons: "multiple+single: rows".
std::string group_of(std::span<const Gatherer> gatherers) {
    std::string names;
    for (const Gatherer& g : gatherers) {
        names += (names.empty() ? "" : "+") + std::string(g.effect->name);
    }
    return names.empty() ? kPreparationGroup : names + ": rows";
}

// The rows of all receivers, in their order; one stage of the report for each set.
formats::Result<GatheredRows> bake_rows(const BakeInputs& bake, const VolumesBefore* volumes,
                                        std::span<const SubjectState> subjects, const Knobs& knobs,
                                        const Context& context, const BakeExtras& extras,
                                        StageLog& log) {
    std::vector<float> errors;
    RowSink sink =
        make_row_sink(make_row_encoder(knobs.cubemap_size, knobs.coefficients, knobs.code_bits));
    const std::uint32_t total = count_receivers(bake.receivers);
    SharedBatches batches(bake, subjects, knobs, context);
    for (std::size_t s = 0; s < bake.receivers.size(); ++s) {
        const ReceiverSet& set = bake.receivers[s];
        const SubjectState* const subject =
            set.size() == 0 ? nullptr : &state_of(subjects, set.material);
        if (subject == nullptr) continue;
        std::vector<Gatherer> gatherers = make_gatherers(bake, *subject, knobs, context);
        std::string group = group_of(gatherers);
        RowJob job{set, subject->layout, sink.encoder, total};
        job.measures_errors = extras.receiver_errors;
        job.volumes = volumes;
        job.material = &bake.scene.materials[set.material];
        GatheredRows gathered =
            run_stage(log, "rows of '" + bake.scene.primitives[set.primitive].name + "'",
                      std::move(group), [&](std::uint64_t& rays) {
                          const SharedBatches::Found shared = batches.find(s, rays);
                          job.shared = shared.gatherers;
                          job.place = shared.place;
                          return gather_rows(job, std::move(gatherers), context, rays);
                      });
        formats::SparseRows& part = gathered.rows;
        if (context.cancelled()) break;
        const RowLayout& layout = subject->layout;
        if (auto status = require_finite(part, layout.terms(), layout.bands(), log.back().name);
            !status) {
            return std::move(status).error();
        }
        if (part.row_offset.size() != layout.terms() * set.size() + 1 ||
            !take_rows(sink, std::move(part))) {
            return formats::make_error(formats::ErrorKind::resource, "", "transport",
                                       "more than 2^32 coefficients do not fit into one file",
                                       "lower --coefficients, or split the scene");
        }
        errors.insert(errors.end(), gathered.receiver_error.begin(), gathered.receiver_error.end());
    }
    return GatheredRows{std::move(sink.rows), std::move(errors)};
}

// Of all receivers; empty where nothing is glossy.
std::vector<formats::Openness> bake_all_openness(const BakeInputs& bake,
                                                 std::span<const SubjectState> subjects,
                                                 const Context& context, StageLog& log) {
    std::vector<formats::Openness> openness;
    if (std::none_of(subjects.begin(), subjects.end(),
                     [](const SubjectState& s) { return s.layout.mirrors; })) {
        return openness;
    }
    return run_stage(log, "openness", "openness", [&](std::uint64_t& traced) {
        const DirectionSet directions = make_sparse_direction_set(kOpennessCubemap, 0);
        for (const ReceiverSet& set : bake.receivers) {
            if (set.size() > 0 && state_of(subjects, set.material).layout.mirrors) {
                const bool occluded = state_of(subjects, set.material).layout.occluded;
                const auto part = bake_openness(occluded ? bake.rays : bake.sky, directions,
                                                set.outside, context, traced);
                openness.insert(openness.end(), part.begin(), part.end());
            }
            openness.resize(set.first + set.size());
        }
        return std::move(openness);
    });
}

// The plan after the studies: rules decide again with their findings.
void amend_plan(const BakeInputs& bake, std::span<const SubjectState> subjects, const Knobs& knobs,
                const Context& context, std::vector<PlanEntry>& plan) {
    const auto amend = [&](PlanEntry& entry) {
        const auto e =
            static_cast<std::size_t>(&bake.effects[entry.effect] - bake.effects.effects.data());
        const SubjectState& subject = state_of(subjects, entry.subject.index);
        const DecisionRule& rule = rule_of(bake.effects, entry);
        if (rule.amend != nullptr && subject.effects[e].study != nullptr) {
            rule.amend(inputs_of(bake, subject, e, knobs, context), entry);
        }
    };
    replace_entries(Subject::Kind::material,
                    plan_bake(bake.effects, bake.scene, bake.facts, knobs, amend), plan);
}

void warn_of_models(const BakeInputs& bake, std::span<const SubjectState> subjects,
                    const Knobs& knobs, const Context& context,
                    std::vector<formats::Diagnostic>& warnings) {
    for (const SubjectState& subject : subjects) {
        for (std::size_t e = 0; e < subject.effects.size(); ++e) {
            const EffectDescriptor& effect = bake.effects.effects[e];
            if (subject.effects[e].acts && effect.warn_of_model != nullptr) {
                effect.warn_of_model(inputs_of(bake, subject, e, knobs, context), warnings);
            }
        }
    }
}

// Light of surfaces, for surfaces and for volumes.
struct SurfaceLight {
    std::optional<OtherLight> shared;           // what they send to each other
    std::shared_ptr<const BounceLight> lonely;  // where they do not, but volumes see them

    const BounceLight* seen() const { return shared ? shared->surfaces.get() : lonely.get(); }
};

SurfaceLight find_light_of_surfaces(const BakeInputs& unlit, const Knobs& knobs,
                                    std::span<const VolumeLayout> volumes, const Context& context,
                                    std::vector<SubjectState>& subjects, StageLog& log) {
    const bool is_seen = !unlit.scene.primitives.empty() && sees_surfaces(volumes);
    const std::vector<Receiver> onlookers =
        is_seen ? draw_onlookers(unlit.scene, volumes) : std::vector<Receiver>();
    const std::vector<RowLayout> layouts = layouts_of(unlit.scene, subjects);
    const LightRequest request{unlit, knobs, context, layouts, subjects, onlookers, log};
    SurfaceLight light{find_shared_light(request), nullptr};
    if (is_seen && light.seen() == nullptr) {
        light.lonely = find_surface_light(request);
    }
    return light;
}

// What an inspected scene becomes: all stages from the receivers on. `subjects`: left studied.
formats::Status bake_inspected(const BakeInputs& unlit, const Context& context,
                               const BakeExtras& extras, std::vector<SubjectState>& subjects,
                               BakeResult& result) {
    Knobs& knobs = result.knobs;
    StageLog& log = result.stages;
    std::vector<TestLight> lights;  // none where there is nothing to relight
    if (count_receivers(unlit.receivers) > 0) {
        auto made = run_stage(log, "test lights", [&](std::uint64_t&) {
            return make_test_lights(
                knobs.cubemap_size, context.threads,
                context.cache.empty() ? context.cache : context.cache / "test-lights");
        });
        if (!made) return std::move(made).error();
        lights = std::move(*made);
    }
    subjects = begin_subjects(unlit, result.plan, knobs);
    run_step(Step::study, unlit, knobs, context, subjects, log);
    amend_plan(unlit, subjects, knobs, context, result.plan);
    settle_subjects(unlit, result.plan, knobs, subjects);
    knobs = with_model_error(unlit.effects, knobs, find_model_error(result.plan));
    run_step(Step::study, unlit, knobs, context, subjects, log);  // of effects that act only now
    const std::vector<VolumeLayout> planned = plan_volumes(unlit.scene, knobs).layouts;
    const SurfaceLight light =
        find_light_of_surfaces(unlit, knobs, planned, context, subjects, log);
    BakeInputs bake = unlit;
    bake.light = light.shared ? &*light.shared : nullptr;
    const VolumeStages stages{bake.effects, bake.scene, bake.rays, light.seen()};
    std::optional<formats::Result<BakedVolumes>> volumes;
    if (!subjects.empty() && colours_surfaces(bake.scene, planned)) {
        std::ranges::for_each(subjects, [](SubjectState& s) { s.layout.coloured = true; });
    }
    if (!planned.empty() &&
        knobs.error_target <= 0) {  // samples come when their memory is free again
        volumes.emplace(bake_and_measure(stages, knobs, context, log));
        if (!*volumes) return std::move(*volumes).error();
    }
    if (knobs.error_target > 0) {
        result.accuracy.emplace();
        knobs = choose_knobs(bake, knobs, context, {subjects, lights, log, *result.accuracy});
        amend_plan(bake, subjects, knobs, context, result.plan);
        if (!planned.empty()) {
            volumes.emplace(bake_and_measure(stages, knobs, context, log));
            if (!*volumes) return std::move(*volumes).error();
            keep_knobs(bake.effects, **volumes, knobs);
        }
    } else {
        run_step(Step::samples, bake, knobs, context, subjects, log);
    }
    const bool is_before = volumes && count_receivers(bake.receivers) > 0;
    const std::optional<SentLight> sent =
        is_before ? find_sent_light(stages, **volumes, knobs) : std::nullopt;
    const std::optional<VolumesBefore> before =
        is_before ? std::optional(make_volumes_before(bake.scene, knobs, sent ? &*sent : nullptr))
                  : std::nullopt;
    run_step(Step::prepare, bake, knobs, context, subjects, log);
    if (context.cancelled()) return interrupted();
    formats::Result<GatheredRows> rows =
        bake_rows(bake, before ? &*before : nullptr, subjects, knobs, context, extras, log);
    if (!rows) return std::move(rows).error();
    warn_of_models(bake, subjects, knobs, context, result.warnings);
    if (light.shared) {
        if (auto warning = describe_unsettled(*light.shared)) {
            result.warnings.push_back(std::move(*warning));
        }
    }
    std::vector<formats::Openness> openness = bake_all_openness(bake, subjects, context, log);
    if (context.cancelled()) return interrupted();
    result.asset = pack_asset(bake.scene, layouts_of(bake.scene, subjects), std::move(rows->rows),
                              std::move(openness));
    result.receiver_errors = std::move(rows->receiver_error);
    result.error = run_stage(log, "self-check", "self-check", [&](std::uint64_t& traced) {
        return check_file({bake, subjects, knobs, lights, before ? &*before : nullptr},
                          result.asset.view(), context, traced);
    });
    if (context.cancelled()) return interrupted();
    for (const std::string_view name : unmeasured_effects(bake.effects, result.plan)) {
        result.error.not_measured.emplace_back(name);
    }
    for (formats::Diagnostic& warning : describe_measured_error(bake.scene, knobs, result.error)) {
        result.warnings.push_back(std::move(warning));
    }
    if (result.accuracy) {
        warn_of_missed_target(bake.effects, *result.accuracy, knobs,
                              result.error.at_receivers.rms_relative, result.warnings);
        result.accuracy->met = result.accuracy->met && meets_target(result.error, knobs);
    }
    std::ranges::for_each(subjects, forget_samples);
    if (volumes) {
        add_volumes(bake.scene, std::move(**volumes), result);
        if (result.accuracy) {
            result.accuracy->met = result.accuracy->met && meets_target(result.error, result.knobs);
        }
    }
    return formats::ok_status();
}

formats::Status check_model_of(const EffectTable& effects, const formats::Scene& scene,
                               const Context& context, BakeResult& result) {
    ModelCheckOptions options;
    options.simulated = held_light(effects, result.plan);
    options.lit_by_volumes = lights_surfaces(result.plan);
    options.volumes_see_surfaces = sees_surfaces(result.plan);
    options.seed = result.knobs.seed;
    auto checked = run_stage(result.stages, "model check", [&](std::uint64_t&) {
        return check_model(scene, result.asset.view(), options, context);
    });
    if (!checked) return std::move(checked).error();
    result.model_error = std::move(*checked);
    return formats::ok_status();
}

}  // namespace

formats::Result<BakeResult> run_bake(const EffectTable& effects, const formats::Scene& given,
                                     const Knobs& wanted, const Context& outer,
                                     const BakeExtras& extras) {
    const Clock::time_point start = Clock::now();
    Context context = outer;
    context.threads = thread_count(outer);
    BakeResult result;
    result.knobs = wanted;
    result.threads = context.threads;
    StageLog& log = result.stages;

    const OrientedBodies bodies =
        run_stage(log, "bodies", [&](std::uint64_t&) { return orient_bodies(given); });
    const formats::Scene& facing = bodies.scene ? *bodies.scene : given;
    result.warnings = describe_faults(given, bodies.surfaces);
    const auto evened = takes_even_media(effects, wanted) ? even_media(facing) : std::nullopt;
    if (evened) {
        std::ranges::copy(evened->warnings, std::back_inserter(result.warnings));
    }
    const formats::Scene& scene = evened ? evened->scene : facing;
    ScenePlan plan =
        run_stage(log, "plan", [&](std::uint64_t&) { return plan_scene(effects, scene, wanted); });
    result.plan = std::move(plan.entries);
    result.facts = std::move(plan.facts);
    if (auto status = check_lamps(scene, plan.count_emitters(), kEmitters); !status) {
        return std::move(status).error();
    }
    if (extras.on_planned) {
        extras.on_planned(scene, result);
    }
    formats::Result<RayScene> sky = RayScene::build({}, context.threads);
    if (!sky) return std::move(sky).error();
    std::optional<RayScene> hierarchy;
    if (needs_hierarchy(layout_rows(effects, scene, result.plan, wanted)) ||
        (!plan.volumes.empty() && !scene.primitives.empty()) || !plan.lamps.empty()) {
        formats::Result<RayScene> built = run_stage(log, "hierarchy", [&](std::uint64_t&) {
            return RayScene::build(scene, context.threads);
        });
        if (!built) return std::move(built).error();
        hierarchy = std::move(*built);
    }
    const RayScene& rays = hierarchy ? *hierarchy : *sky;
    const std::vector<ReceiverSet> receivers = run_stage(
        log, "receivers", [&](std::uint64_t&) { return place_receivers(scene, rays, context); });
    BakeInputs bake{effects, scene, result.facts, rays, *sky, receivers};
    std::optional<ScenePyramids> textures;
    if (const auto filtered = filtered_materials(
            scene, layout_rows(effects, scene, result.plan, wanted), !plan.lamps.empty());
        !filtered.empty()) {
        textures = run_stage(log, "textures",
                             [&](std::uint64_t&) { return make_scene_pyramids(scene, filtered); });
        bake.textures = &*textures;
    }
    std::vector<SubjectState> subjects;
    if (auto status = bake_inspected(bake, context, extras, subjects, result); !status) {
        return std::move(status).error();
    }
    if (!plan.layers.empty()) {
        if (auto status = add_layers(scene, plan.layers, context, result); !status) {
            return std::move(status).error();
        }
    }
    if (!plan.lamps.empty()) {
        if (auto status = add_lamp_rows(bake, plan.lamps, context, subjects, result); !status) {
            return std::move(status).error();
        }
    }
    number_glow(plan.lamps, result);
    if (wanted.check_model && !scene.primitives.empty()) {
        if (auto status = check_model_of(effects, facing, context, result); !status) {
            return std::move(status).error();
        }
    }
    result.asset.provenance = make_provenance(scene, result);
    result.seconds_total = seconds_since(start);
    return result;
}

}  // namespace opaline::bake
