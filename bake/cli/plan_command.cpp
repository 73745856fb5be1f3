#include <fmt/core.h>

#include <algorithm>
#include <iterator>
#include <memory>

#include "bake/base/ordered_parallel.h"
#include "bake/cli/command.h"
#include "bake/cli/inputs.h"
#include "bake/cli/machine_rates.h"
#include "bake/cli/messages.h"
#include "bake/cli/report.h"
#include "bake/cli/scene_options.h"
#include "bake/effects/effects.h"
#include "bake/emitters/plan_emitters.h"
#include "bake/layers/plan_layers.h"
#include "bake/pipeline/savings.h"
#include "bake/pipeline/unmet_requests.h"
#include "bake/scene/cancel_flaps.h"
#include "bake/scene/even_media.h"
#include "bake/scene/inspect_scene.h"
#include "bake/scene/orient_bodies.h"
#include "bake/volumes/plan_volumes.h"
#include "bake/volumes/volume_effects.h"

namespace opaline::cli {
namespace {

struct PlanCommand {
    SceneOptions scene;
    bool json = false;
};

// As the bake will warn of it. Which faces must be turned takes it seconds to find out.
std::vector<formats::Diagnostic> describe_media_faults(const formats::Scene& scene,
                                                       const bake::SceneFacts& facts) {
    std::vector<bake::BodySurface> surfaces;
    for (std::uint32_t m = 0; m < scene.materials.size(); ++m) {
        if (scene.materials[m].medium) {
            surfaces.push_back(
                {m, 0, facts.material[m].open_edges, bake::find_flaps(scene, m).pairs});
        }
    }
    return bake::describe_faults(scene, surfaces);
}

int run(const PlanCommand& options) {
    const bake::EffectTable& effects = bake::all_effects();
    const auto wanted = parse_effects(options.scene);
    const auto knobs = require(bake::resolve_knobs(effects, wanted));
    const auto imported = open_scene(options.scene, knobs, formats::CloudDetail::largest);
    require(bake::check_effects(effects, imported.scene, knobs));
    bake::Context context;
    context.threads = options.scene.bake.threads;
    const unsigned threads = bake::thread_count(context);
    const auto evened =
        bake::takes_even_media(effects, knobs) ? bake::even_media(imported.scene) : std::nullopt;
    const formats::Scene& scene = evened ? evened->scene : imported.scene;
    const bake::SceneFacts facts = bake::inspect_scene(scene);
    auto plan = bake::plan_bake(effects, scene, facts, knobs);
    bake::VolumePlan planned = bake::plan_volumes(scene, knobs);
    std::vector<bake::PlanEntry> volumes = std::move(planned.entries);
    std::ranges::copy(bake::plan_layers(scene, knobs).entries, std::back_inserter(volumes));
    const bake::EmitterPlan emitters = bake::plan_emitters(scene, knobs);
    require(bake::check_lamps(
        scene, bake::count_emitters(emitters.lamps, bake::count_glowing(planned.layouts)),
        bake::kEmitters));
    std::ranges::copy(emitters.entries, std::back_inserter(volumes));
    std::vector<formats::Diagnostic> warnings = describe_media_faults(scene, facts);
    if (evened) {
        warnings.insert(warnings.end(), evened->warnings.begin(), evened->warnings.end());
    }
    for (formats::Diagnostic& unmet :
         bake::describe_unmet({effects, scene, facts, knobs, plan, volumes}, wanted)) {
        warnings.push_back(std::move(unmet));
    }
    require(report_warnings(warnings));
    const bake::StageRates rates = find_machine_rates().rates;
    const bake::Knobs budget = bake::with_model_error(effects, knobs, bake::find_model_error(plan));
    const bake::CostRequest request{effects, scene, facts, budget, rates, threads};
    const bake::CostPrediction cost = bake::predict_costs(request, plan, volumes);
    bake::predict_savings(request, plan);
    plan.insert(plan.end(), volumes.begin(), volumes.end());
    fmt::print("{}", options.json ? make_plan_json(budget, plan, cost)
                                  : make_plan_table(budget, plan, cost, threads));
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
