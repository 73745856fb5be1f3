#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "bake/base/ordered_parallel.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/messages.h"
#include "bake/cli/report.h"
#include "bake/cli/scene_options.h"
#include "bake/effects/effects.h"
#include "bake/pipeline/calibration/rates_cache.h"
#include "bake/pipeline/plan_scene.h"
#include "bake/pipeline/refine_stage.h"
#include "bake/pipeline/savings.h"
#include "bake/pipeline/unmet_requests.h"
#include "bake/scene/cancel_flaps.h"
#include "bake/scene/medium_field.h"
#include "bake/scene/orient_bodies.h"
#include "bake/scene/shared_rows.h"

namespace opaline::cli {
namespace {

struct PlanCommand {
    SceneOptions scene;
    bool json = false;
};

// As the bake will warn of it, of large scenes: which of their faces must be turned takes seconds.
std::vector<formats::Diagnostic> describe_media_faults(const formats::Scene& scene,
                                                       const bake::SceneFacts& facts) {
    std::vector<bake::BodySurface> surfaces;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (scene.materials[m].medium) {
            const bake::Flaps flaps = bake::find_flaps(scene, m);
            surfaces.push_back({m, 0, facts.material[m].open_edges, flaps.pairs, flaps.repeats});
        }
    }
    return bake::describe_faults(scene, surfaces);
}

// A plan answers within seconds: large meshes are taken as they are, of which few receivers are
// missing.
bool is_quick_to_refine(const formats::Scene& scene) {
    constexpr std::size_t kMost = 100000;
    std::size_t vertices = 0;
    for (const formats::Primitive& p : scene.primitives) {
        vertices += p.position.size();
    }
    return vertices <= kMost;
}

int run(const PlanCommand& options) {
    const bake::EffectTable& effects = bake::all_effects();
    const auto wanted = parse_effects(options.scene);
    auto knobs = require(bake::resolve_knobs(effects, wanted));
    const auto imported = open_scene(options.scene, knobs, formats::CloudDetail::largest);
    knobs = fit_memory(options.scene, imported.scene, knobs);
    require(bake::check_effects(effects, imported.scene, knobs));
    bake::Context context;
    context.threads = options.scene.bake.threads;
    const unsigned threads = bake::thread_count(context);
    bake::StageLog log;
    const bool is_quick = is_quick_to_refine(imported.scene);
    const bake::OrientedBodies bodies =
        is_quick ? bake::orient_bodies(imported.scene) : bake::OrientedBodies{};
    const formats::Scene& turned = bodies.scene ? *bodies.scene : imported.scene;
    const bake::RefinedScene refined =
        is_quick ? require(bake::refine_for_bake(turned, knobs, context, log))
                 : bake::RefinedScene{};
    const formats::Scene& dense = refined.scene ? *refined.scene : turned;
    const auto evened =
        bake::takes_even_media(effects, knobs) ? bake::even_media(dense) : std::nullopt;
    const formats::Scene& scene = evened ? evened->scene : dense;
    bake::SimplifiedScene simplified;
    if (is_quick_to_refine(scene)) {
        simplified = require(bake::simplify_for_bake(scene, knobs, context, log));
    } else if (knobs.simplify) {
        simplified.slots = bake::find_slots(scene);
    }
    bake::ScenePlan plan = bake::plan_scene(effects, scene, std::move(simplified.slots), knobs);
    require(bake::check_lamps(scene, plan.count_emitters(), bake::kEmitters));
    std::vector<formats::Diagnostic> warnings =
        is_quick ? bake::describe_faults(imported.scene, bodies.surfaces)
                 : describe_media_faults(scene, plan.facts);
    if (evened) {
        warnings.insert(warnings.end(), evened->warnings.begin(), evened->warnings.end());
    }
    for (formats::Diagnostic& unmet :
         bake::describe_unmet({effects, scene, plan.facts, knobs, plan.entries}, wanted)) {
        warnings.push_back(std::move(unmet));
    }
    require(report_warnings(warnings));
    const bake::StageRates rates = bake::find_machine_rates().rates;
    const bake::Knobs budget =
        bake::with_model_error(effects, knobs, bake::find_model_error(plan.entries));
    const bake::CostRequest request{.effects = effects,
                                    .scene = scene,
                                    .facts = plan.facts,
                                    .knobs = budget,
                                    .rates = rates,
                                    .threads = threads,
                                    .refinement_rays = refined.report.rays};
    const bake::CostPrediction cost = bake::predict_costs(request, plan.entries);
    bake::predict_savings(request, plan.entries);
    fmt::print("{}", options.json
                         ? make_plan_json(budget, refined.report, plan.entries, cost)
                         : make_plan_table(budget, refined.report, plan.entries, cost, threads));
    return kExitSuccess;
}

}  // namespace

void add_plan_command(Program& program) {
    auto [command, options] = add_command<PlanCommand>(
        program, "plan", "Say what a bake of the scene would simulate, and why", run);
    add_scene_options(command, options.scene);
    add_error_option(command, options.scene);
    command.add_flag("--json", options.json, "print JSON");
    command.footer("Example:\n  opaline plan scene.glb --quality production");
}

}  // namespace opaline::cli
