#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/knobs.h"
#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

struct Prepared;  // plan_input.h

/// The subject of a decision. A material represents its surfaces and the medium inside. A whole
/// plan has the decisions on materials first, then the others in the order of their kinds.
struct Subject {
    enum class Kind : std::uint8_t { material, volume, layer, emitter } kind = Kind::material;
    std::uint32_t index = 0;  ///< into Scene::materials, volumes or layers; number of the emitter
    std::string name;         ///< for messages and reports: "material 'Floor'"
};

/// Identifies an effect; the enumerators are defined beside the table (effects/effects.h).
enum class Effect : std::uint8_t;

/// One decision: an effect, or a part of one, for a subject.
struct PlanEntry {
    Effect effect{};        ///< of decisions on materials; the others belong to no rule
    std::uint8_t rule = 0;  ///< index into the effect's rules
    std::string_view name;  ///< the rule's: the effect's, or effect.part (design: effect names)
    Subject subject;
    bool on = false;
    bool forced = false;       ///< below the bound, but forced on by Knobs::simulate_all
    bool has_bands = false;    ///< its light differs between red, green and blue
    bool alternative = false;  ///< it would replace other effects: turning it on is no addition
    bool as_surface = false;   ///< it shows a medium as a surface: nothing enters, nothing mirrors
    /// On: its rows can hold light of all orders of scattering. Off: left to such rows.
    bool all_orders = false;
    bool layered = false;  ///< on: light goes through other media inside; straight paths do not
    std::string_view choice{};  ///< on or off: the way it takes of several; empty: none or unknown
    std::string reason;         ///< the rule in words
    double bound = 0;           ///< largest radiance it can contribute under `white`
    double model_error = 0;     ///< relative RMS error of the model; 0 where unknown
    std::uint32_t terms = 0;    ///< of rules that choose a number of rows: that number; otherwise 0
    std::uint32_t least_terms = 1;      ///< that number if the rule were on
    double predicted_seconds = 0;       ///< filled in by predict_costs (cost_model.h)
    std::uint64_t predicted_bytes = 0;  ///< the same; of the rows in the file
    double saved_seconds = 0;           ///< by being off; filled in by predict_savings (savings.h)
    std::uint64_t saved_bytes = 0;      ///< the same; of the rows in the file
};

/// Decides what to simulate of materials, from the scene and from what effects found when they
/// studied it: traces nothing. Subject by subject, and for each in the order of the effects and
/// their rules: later ones see earlier ones. `facts`: inspect_scene's. `studies`: material *
/// effects + effect, null where there is none; empty: nothing is studied yet.
std::vector<PlanEntry> plan_bake(const EffectTable& effects, const formats::Scene& scene,
                                 const SceneFacts& facts, const Knobs& knobs,
                                 std::span<const Prepared* const> studies = {});

/// Largest known relative RMS error of a plan's models over its subjects.
double find_model_error(std::span<const PlanEntry> plan);

/// What effects of materials chose, each once, in the order of the plan: "dipole, walks".
std::string list_choices(std::span<const PlanEntry> plan);

/// The subjects of a scene: materials that have receivers.
std::vector<Subject> list_subjects(const formats::Scene& scene, const SceneFacts& facts);

/// The entry of that name for a material; null: there is none.
const PlanEntry* find_entry(std::span<const PlanEntry> plan, std::string_view name,
                            std::uint32_t material);

/// The entries of one material, which are consecutive.
std::span<const PlanEntry> entries_of(std::span<const PlanEntry> plan, std::uint32_t material);

/// The entries on subjects of one kind, which are consecutive.
std::span<const PlanEntry> entries_of(std::span<const PlanEntry> plan, Subject::Kind kind);

/// Whether a decision of that name, or on a subject of that kind, is on.
bool is_on(std::span<const PlanEntry> plan, std::string_view name);
bool is_on(std::span<const PlanEntry> plan, Subject::Kind kind);

/// Puts other decisions in the place of those on subjects of that kind.
void replace_entries(Subject::Kind kind, std::span<const PlanEntry> entries,
                     std::vector<PlanEntry>& plan);

}  // namespace opaline::bake
