#include "bake/pipeline/pipeline.h"

#include <algorithm>
#include <iterator>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "bake/base/interrupted.h"
#include "bake/base/ordered_parallel.h"
#include "bake/check/error_warnings.h"
#include "bake/check/measure_error.h"
#include "bake/effects/rows/gather_rows.h"
#include "bake/effects/volumes/place_nodes.h"
#include "bake/effects/volumes/plan_volumes.h"
#include "bake/effects/volumes/volume_effects.h"
#include "bake/encode/pack_asset.h"
#include "bake/pipeline/emitter_stages.h"
#include "bake/pipeline/filtered_textures.h"
#include "bake/pipeline/layer_stages.h"
#include "bake/pipeline/plan_scene.h"
#include "bake/pipeline/provenance.h"
#include "bake/pipeline/refine_stage.h"
#include "bake/pipeline/row_stages.h"
#include "bake/pipeline/shared_light.h"
#include "bake/pipeline/volume_stages.h"
#include "bake/receivers/body_points.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/copies.h"
#include "bake/scene/medium_field.h"
#include "bake/scene/orient_bodies.h"
#include "bake/scene/shared_rows.h"
#include "bake/trace/contacts.h"
#include "bake/trace/hidden_receivers.h"
#include "bake/trace/touching_triangles.h"

namespace opaline::bake {
namespace {

// Leaves the receivers that are slots, of those of all places.
void keep_slots(const formats::SlotsView& slots, std::vector<ReceiverSet>& sets) {
    std::uint32_t place = 0, next = 0;
    for (ReceiverSet& set : sets) {
        const std::uint32_t end = place + static_cast<std::uint32_t>(set.size());
        ReceiverSet kept = set;
        kept.first = next;
        kept.outside.clear();
        kept.inside.clear();
        while (next < slots.vertex.size() && slots.place[slots.vertex[next]] < end) {
            const std::uint32_t i = slots.place[slots.vertex[next++]] - place;
            kept.outside.push_back(set.outside[i]);
            kept.inside.push_back(set.inside[i]);
        }
        set = std::move(kept);
        place = end;
    }
}

std::vector<ReceiverSet> place_receivers(const formats::Scene& scene, const SceneFacts& facts,
                                         const RayScene& rays, const Context& context) {
    std::vector<Receiver> vertices =
        leave_touching_triangles(rays.hierarchy(), scene, make_vertex_receivers(scene), context);
    std::vector<BodyPoint> inside = make_body_points(scene, vertices);
    std::vector<std::uint32_t> all(vertices.size());
    std::iota(all.begin(), all.end(), 0u);
    look_beside_contacts(find_contacts(rays.hierarchy(), scene, all, context), vertices, inside);
    vertices = replace_hidden_receivers(rays, scene, std::move(vertices), context);
    const std::vector<std::uint32_t> stand_in =
        find_stand_ins(scene, facts, rays.hierarchy(), context);
    for (std::size_t v = 0; v < stand_in.size(); ++v) {
        vertices[v] = vertices[stand_in[v]];
        inside[v] = inside[stand_in[v]];
    }
    return make_vertex_sets(scene, vertices, inside);
}

// The plan after the studies: rules decide again with their findings.
void amend_plan(const BakeInputs& bake, std::span<const SubjectState> subjects, const Knobs& knobs,
                std::vector<PlanEntry>& plan) {
    std::vector<const Prepared*> studies;
    for (std::uint32_t m = 0; m < bake.scene.materials.size(); ++m) {
        for (std::size_t e = 0; e < bake.effects.effects.size(); ++e) {
            const bool is_subject = bake.facts.material[m].receivers > 0;
            studies.push_back(is_subject ? state_of(subjects, m).effects[e].study.get() : nullptr);
        }
    }
    replace_entries(Subject::Kind::material,
                    plan_bake(bake.effects, bake.scene, bake.facts, knobs, studies), plan);
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
// `light`: becomes what surfaces send.
formats::Status bake_inspected(const BakeInputs& unlit, std::span<const Lamp> lamps,
                               const Context& context, const BakeExtras& extras,
                               std::vector<SubjectState>& subjects, SurfaceLight& light,
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
    amend_plan(unlit, subjects, knobs, result.plan);
    settle_subjects(unlit, result.plan, knobs, subjects);
    knobs = with_model_error(unlit.effects, knobs, find_model_error(result.plan));
    run_step(Step::study, unlit, knobs, context, subjects, log);  // of effects that act only now
    const std::vector<VolumeLayout> planned = plan_volumes(unlit.scene, knobs).layouts;
    light = find_light_of_surfaces(unlit, knobs, planned, context, subjects, log);
    BakeInputs bake = unlit;
    bake.light = light.shared ? &*light.shared : nullptr;
    const VolumeStages stages{bake.effects, bake.scene, bake.rays, light.seen(), lamps};
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
        amend_plan(bake, subjects, knobs, result.plan);
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
    formats::Result<GatheredRows> rows = bake_rows(bake, before ? &*before : nullptr, subjects,
                                                   knobs, extras.receiver_errors, context, log);
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
                              std::move(openness), bake.facts.slots);
    result.receiver_errors =
        spread_to_vertices(bake.facts.slots.view(), std::move(rows->receiver_error));
    result.error = run_stage(log, "self-check", "self-check", [&](std::uint64_t& traced) {
        return check_file({bake, subjects, knobs, lights, before ? &*before : nullptr},
                          result.asset.view(), context, traced);
    });
    if (context.cancelled()) return interrupted();
    for (const std::string_view name : unmeasured_effects(bake.effects, result.plan)) {
        result.error.not_measured.emplace_back(name);
    }
    for (formats::Diagnostic& warning :
         describe_measured_error(bake.scene, knobs, result.error, result.refinement.is_bounded())) {
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

// With copies as a reader of the file has them: vertices of their own.
formats::Status check_model_of(const EffectTable& effects, const formats::Scene& given,
                               const Context& context, BakeResult& result) {
    const std::vector<CopiedMesh> copies = find_copied_meshes(given);
    std::optional<formats::Scene> expanded;
    formats::AssetView asset = result.asset.view();
    std::vector<std::uint64_t> words;
    if (!copies.empty()) {
        expand_copies(copies, expanded.emplace(given));
        words.resize(formats::size_with_copies(asset) / sizeof(words[0]) + 1);
        formats::restore_copies(asset, std::as_writable_bytes(std::span(words)));
    }
    const formats::Scene& scene = expanded ? *expanded : given;
    ModelCheckOptions options;
    options.simulated = held_light(effects, result.plan);
    options.lit_by_volumes = lights_surfaces(result.plan);
    options.volumes_see_surfaces = sees_surfaces(result.plan);
    options.seed = result.knobs.seed;
    auto checked = run_stage(result.stages, "model check", [&](std::uint64_t&) {
        return check_model(scene, asset, options, context);
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
    const formats::Scene& turned = bodies.scene ? *bodies.scene : given;
    result.warnings = describe_faults(given, bodies.surfaces);
    formats::Result<RefinedScene> refined = refine_for_bake(turned, wanted, context, log);
    if (!refined) return std::move(refined).error();
    result.refinement = refined->report;
    if (auto warning = describe_bound(refined->report)) {
        result.warnings.push_back(std::move(*warning));
    }
    const formats::Scene& facing = refined->scene ? *refined->scene : turned;
    const auto evened = takes_even_media(effects, wanted) ? even_media(facing) : std::nullopt;
    if (evened) {
        std::ranges::copy(evened->warnings, std::back_inserter(result.warnings));
    }
    const formats::Scene& scene = evened ? evened->scene : facing;
    formats::Result<SimplifiedScene> simplified = simplify_for_bake(scene, wanted, context, log);
    if (!simplified) return std::move(simplified).error();
    result.simplification = simplified->report;
    ScenePlan plan = run_stage(log, "plan", [&](std::uint64_t&) {
        return plan_scene(effects, scene, std::move(simplified->slots), wanted);
    });
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
    const std::vector<ReceiverSet> receivers = run_stage(log, "receivers", [&](std::uint64_t&) {
        const formats::Slots places = places_of(scene, result.facts.slots);
        std::vector<ReceiverSet> sets =
            place_receivers(places.empty() ? scene : merge_vertices(scene, places.view()),
                            result.facts, rays, context);
        if (!result.facts.slots.mix.empty()) keep_slots(result.facts.slots.view(), sets);
        return sets;
    });
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
    SurfaceLight light;
    if (auto status = bake_inspected(bake, plan.lamps, context, extras, subjects, light, result);
        !status) {
        return std::move(status).error();
    }
    if (!plan.layers.empty()) {
        if (auto status = add_layers(scene, plan.layers, context, result); !status) {
            return std::move(status).error();
        }
    }
    if (!plan.lamps.empty()) {
        if (auto status =
                add_lamp_rows(bake, plan.lamps, light.shared ? light.shared->surfaces : nullptr,
                              context, subjects, result);
            !status) {
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
    result.scene = std::move(refined->scene);
    result.seconds_total = seconds_since(start);
    return result;
}

}  // namespace opaline::bake
