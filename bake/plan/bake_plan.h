#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/knobs.h"
#include "bake/plan/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// One decision: an effect, or how much of it (`effect.part`), for a subject (a material).
struct PlanEntry {
    std::string effect;          ///< design 3, "Effect names"
    std::string subject;         ///< "material 'Floor'"
    std::uint32_t material = 0;  ///< index into Scene::materials
    bool on = false;
    bool forced = false;           ///< on although the rule would leave it out: Knobs::simulate_all
    std::string reason;            ///< the rule in words
    double bound = 0;              ///< largest radiance it can contribute under `white`
    std::uint32_t terms = 0;       ///< `single.terms`: of the phase function, the first included
    double predicted_seconds = 0;  ///< filled in by predict_costs (cost_model.h)
    std::uint64_t predicted_bytes = 0;  ///< the same; of the rows in the file
    double saved_seconds = 0;           ///< by being off; filled in by predict_savings (savings.h)
    std::uint64_t saved_bytes = 0;      ///< the same; of the rows in the file
};

/// Decides what to simulate, from the scene alone: traces nothing. `facts`: inspect_scene's.
std::vector<PlanEntry> plan_bake(const formats::Scene& scene, const SceneFacts& facts,
                                 const Knobs& knobs);

/// The entry of an effect for a material; null: there is none.
const PlanEntry* find_entry(const std::vector<PlanEntry>& plan, std::string_view effect,
                            std::uint32_t material);

}  // namespace opaline::bake
