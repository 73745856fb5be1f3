#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bake/base/context.h"
#include "bake/lights/luminance.h"
#include "bake/lights/test_lights.h"
#include "bake/plan/bake_inputs.h"
#include "bake/plan/dense_rows.h"
#include "bake/plan/knob.h"
#include "bake/plan/plan_input.h"
#include "bake/plan/row_layout.h"
#include "bake/plan/stage_work.h"
#include "formats/opal/result.h"
#include "formats/opal/terms.h"

namespace opaline::bake {

using PreparedPtr = std::unique_ptr<Prepared>;

struct EffectInputs;

/// One decision of an effect: the effect as a whole, or a part that is decided by itself.
struct DecisionRule {
    std::string_view name;  ///< that of the effect, or effect.part
    bool (*concerns)(const PlanInput& input);
    /// Everything but effect, rule, name and subject. Traces nothing. Asked again once the effect
    /// has studied the subject (PlanInput::study).
    PlanEntry (*decide)(const PlanInput& input);
    /// What the decision means to the subject's rows.
    void (*lay_out)(const PlanEntry& entry, RowLayout& layout);
    /// Warnings where knobs contradict the decision.
    void (*warn)(const PlanInput& input, const PlanEntry& entry,
                 std::vector<formats::Diagnostic>& warnings) = nullptr;
    /// On: light of the reference that the file holds, beside the light of all files.
    formats::TermSet held = formats::TermSet::none;
};

/// How far an effect has come with one subject; null where a step did not run.
struct EffectState {
    bool acts = false;
    PreparedPtr study, samples, prepared;
};

/// What a function of an effect works on: one material of a bake.
struct EffectInputs {
    const BakeInputs& bake;
    std::uint32_t material = 0;
    const RowLayout& layout;
    const Knobs& knobs;
    const Context& context;
    std::span<const EffectState> states;  ///< of all effects, in the order of the table
    const EffectState& own;               ///< the effect's

    const formats::Medium& medium() const { return *bake.scene.materials[material].medium; }
    /// Occluders of the material's receivers; empty where nothing blocks their light.
    const RayScene& outside() const { return layout.occluded ? bake.rays : bake.sky; }
};

/// A step that runs once for a subject, before its rows. `run` null: the effect has none.
struct PreparationStep {
    std::string_view stage{};  ///< of the report, with a subject's name where `by_subject`; empty:
                               ///< its time is negligible
    bool by_subject = false;
    bool (*applies)(const formats::Material& material, const RowLayout& layout) = nullptr;
    PreparedPtr (*run)(const EffectInputs& inputs, std::uint64_t& rays) = nullptr;
    Work (*work)(const SubjectCost& cost) = nullptr;
    /// Memory of its result for one subject, at most [bytes].
    double (*bytes)(const Knobs& knobs) = nullptr;
    /// Sets the knobs of a finer result, for the pilot's rounds; false: there is none.
    bool (*refine)(Knobs& knobs) = nullptr;
};

/// How an effect adds to dense rows. `add` null: it fills none.
struct GatherStep {
    bool (*applies)(const RowLayout& layout) = nullptr;  ///< null: always
    /// Effects that gather many receivers together do so batch by batch: receivers of a batch that
    /// takes `bytes` of memory, at least 1. Null: receiver by receiver.
    std::size_t (*batch_size)(const Prepared& prepared, std::size_t bytes) = nullptr;
    PreparedPtr (*gather_batch)(const EffectInputs& inputs, std::span<const BodyPoint> points,
                                std::uint64_t& rays) = nullptr;
    /// Adds the effect's light to the rows of one receiver. Any thread; returns the rays traced.
    std::uint64_t (*add)(const EffectInputs& inputs, const GatherReceiver& receiver,
                         const DenseRow& row) = nullptr;
    /// Of all rows of `cost.receivers` receivers.
    Work (*work)(const SubjectCost& cost) = nullptr;
    /// Rows of a receiver of a medium, before anything is planned; null: one.
    double (*typical_rows)(const formats::Medium& medium, const Knobs& knobs) = nullptr;
};

/// Effort of a truth at a receiver.
struct TruthEffort {
    double target = 0;  ///< of a pilot: relative RMS asked for; 0: of a self-check
};

/// The effect's light at a receiver by a way that shares nothing with its other steps. `make` null:
/// the effect fills no rows.
struct TruthStep {
    std::string_view reference{};  ///< in words, for the report
    bool is_expensive = false;     ///< a check costs as much as the rows of dozens of receivers
    PreparedPtr (*make)(const EffectInputs& inputs, TruthEffort effort,
                        std::span<const TestLight> lights) = nullptr;
    TwoEstimates (*eval)(const EffectInputs& inputs, const Prepared& truth,
                         const TruthReceiver& receiver, std::uint64_t& rays) = nullptr;
    /// Of `cost.receivers` receivers.
    Work (*work)(const SubjectCost& cost, TruthEffort effort) = nullptr;
};

/// A straight look at whatever surface is there.
struct SurfaceView {
    glm::vec3 origin{0}, direction{0};  ///< [m], clear of the surface it starts at; unit
    std::array<float, 3> weight{};      ///< of what is seen, by band of the rows
    std::span<const float> factor{};    ///< of each row
};

/// Where light comes from that crosses a medium straight to a point of its boundary from surfaces.
struct CrossingViews {
    /// Weights: share of the radiosity of what is seen that is radiosity of the point, but for the
    /// base colour. No factors.
    std::vector<SurfaceView> views;
    double solid_angle = 0;  ///< [sr] of each
};

/// Work of an effect that lights all surfaces at once.
struct LightWork {
    Work work;                       ///< but for rows of media
    double points = 0;               ///< of all media, at most, whose rows it asks for
    std::uint32_t cubemap_size = 8;  ///< of these rows
    double bytes = 0;                ///< memory that its light keeps until all rows are made
};

/// What an effect works on that lights all surfaces at once.
struct LightInputs {
    const BakeInputs& bake;  ///< without BakeInputs::light
    const Knobs& knobs;
    const Context& context;
    std::span<const RowLayout> layouts;     ///< by material
    std::vector<std::uint8_t> acts;         ///< by material: whether the effect does
    std::uint32_t rays_of_receiver = 0;     ///< to other surfaces, as the effect asks for
    std::span<const Receiver> onlookers{};  ///< places that see surfaces, besides receivers
};

/// The interface of an effect. Plan, cost model, pilot, self-check, sweep, report and command line
/// iterate the table of these and name no effect.
struct EffectDescriptor {
    Effect id{};
    std::string_view name{};  ///< for --effects and reports; that of its folder
    std::string_view help{};  ///< the light that it simulates, in a line; empty: not for --effects
    Subject::Kind kind = Subject::Kind::material;  ///< what it is about
    bool inside_media = false;                     ///< it needs the inside of a medium
    /// Of materials. The first one decides the effect itself, if it has its name; the effect acts
    /// where `gather` applies otherwise.
    std::span<const DecisionRule> rules{};
    std::span<const KnobSpec* const> knobs{};
    std::span<const PilotLadder> pilot{};

    PreparationStep study{};    ///< depends on no knob
    PreparationStep samples{};  ///< independent of the pilot's knobs of rows
    PreparationStep prepare{};  ///< after every knob has its value
    GatherStep gather{};
    TruthStep truth{};
    /// Rays of a receiver to other surfaces, of the effect that has light go from surface to
    /// surface (exchange/; BakeInputs::light). Null: it does not.
    std::uint32_t (*exchange_rays)(const Knobs& knobs) = nullptr;
    LightWork (*light_work)(const CostInput& input) = nullptr;
    bool reads_openness = false;
    /// It adds BakeInputs::light to its rows. Where that replaces the environment, no other acts.
    bool adds_other_light = false;
    /// This effect's part of the answer where light leaves at its entry (RowLayout::at_entry): adds
    /// to f(c), radiance per irradiance at kCosineSteps + 1 evenly spaced cosines from 0 to 1, band
    /// by band.
    void (*add_at_entry)(const EffectInputs& inputs,
                         std::span<std::vector<double>> factor) = nullptr;
    /// Its light comes straight from beyond the medium: from which surfaces, to each of the points.
    /// Null: it does not.
    std::vector<CrossingViews> (*look_through)(const EffectInputs& inputs,
                                               std::span<const BodyPoint> points,
                                               std::uint64_t& rays) = nullptr;
    /// RowLayout::tint of a medium that it shows as a surface.
    formats::Rgb (*tint)(const Prepared& study) = nullptr;
    /// Warnings about light that the model leaves out.
    void (*warn_of_model)(const EffectInputs& inputs,
                          std::vector<formats::Diagnostic>& warnings) = nullptr;
};

inline constexpr std::uint32_t kCosineSteps = 1024;

/// The effects there are, in the order of plans and reports.
struct EffectTable {
    std::span<const EffectDescriptor> effects;

    const EffectDescriptor& operator[](Effect id) const;
};

/// Whether some effect takes media for homogeneous (KnobSpec::even_media).
bool takes_even_media(const EffectTable& effects, const Knobs& knobs);

const DecisionRule& rule_of(const EffectTable& effects, const PlanEntry& entry);

/// Calls visit(effect, rule, number of the rule) for all rules in order.
template <class Visit>
void for_each_rule(const EffectTable& effects, Visit&& visit) {
    for (const EffectDescriptor& effect : effects.effects) {
        for (std::size_t r = 0; r < effect.rules.size(); ++r) {
            visit(effect, effect.rules[r], static_cast<std::uint8_t>(r));
        }
    }
}

/// Whether the effect acts on a subject of these decisions and rows.
bool acts_on(const EffectDescriptor& effect, std::span<const PlanEntry> decisions,
             const RowLayout& layout);

}  // namespace opaline::bake
