#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/effect.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A family of settings that differ in one knob, or in several together.
struct Ladder {
    std::string_view name;           ///< as in tables and files; no two ladders share it
    const KnobSpec* knob = nullptr;  ///< of one effect's knob
    KnobTheory theory{};             ///< how errors fall along it

    bool operator==(const Ladder& other) const { return name == other.name; }
    bool operator<(const Ladder& other) const { return name < other.name; }
};

/// Those of no effect's knob.
struct Ladders {
    static constexpr Ladder preset{"preset"};    ///< draft, preview, production, reference
    static constexpr Ladder cubemap{"cubemap"};  ///< N, all else as in the base
    /// N with all coefficients in 16 bits: N alone.
    static constexpr Ladder resolution{
        "resolution",
        nullptr,
        {.label = "cube map size N",
         .words = "a small light's place is known to a texel: error in proportion to 1/N",
         .rate = -1}};
    /// M.
    static constexpr Ladder coefficients{
        "coefficients",
        nullptr,
        {.label = "coefficients M",
         .words = "M largest Haar coefficients of a function with edges along curves, in L2 "
                  "[DeVore1998]; relit values converge faster, as light has few too",
         .rate = -0.5}};
    static constexpr Ladder code_bits{"code_bits"};    ///< of the stored coefficients
    static constexpr Ladder exact_rays{"exact_rays"};  ///< 0: light maps, shared rays; 1: neither
    static constexpr Ladder grid{"grid"};              ///< N and M together
    static constexpr Ladder diagonal{"diagonal"};      ///< all knobs together, step by step
    /// Of the Monte Carlo reference, which is no bake and has no points.
    static constexpr Ladder reference_samples{"reference_samples",
                                              nullptr,
                                              {.label = "samples of the Monte Carlo reference",
                                               .words = "independent paths, whose variances add",
                                               .rate = -0.5}};
};

/// The ladder of an effect's knob.
constexpr Ladder ladder_of(const KnobSpec& knob) {
    return {knob.name, &knob, knob.theory};
}

/// A point's place on a ladder: `value` is the knob's (of a choice its place among the words), or 0
/// to 3 for presets, N for grids, and the step for the diagonal. All coefficients count as as many
/// as there are.
struct Rung {
    Ladder ladder;
    double value = 0;
};

/// One setting to bake with. No two points of a list make the same bake: a setting on several
/// ladders has several rungs, and the truth may be on none.
struct SweepPoint {
    std::string label;  ///< "preview", "M = 256": that of its first rung
    std::vector<Rung> rungs;
    Knobs knobs;
};

/// A knob that matters only if its effect computes in another way than the plan chose: `word` of
/// `choice`.
struct ChosenKnob {
    const KnobSpec* choice = nullptr;
    std::size_t word = 0;
    const KnobSpec* knob = nullptr;
};

/// The knobs that matter for a scene.
struct SweepSubject {
    std::vector<const KnobSpec*> knobs;  ///< of effects: those that some subject has use for
    bool in_media = false;               ///< light is simulated inside media
    bool has_surfaces = true;            ///< there are vertices, whose rows other knobs concern
    bool has_volumes = false;            ///< light is simulated in volumes
    bool has_layers = false;             ///< and in cloud layers
    std::vector<ChosenKnob> chosen{};    ///< their ladders are baked in that way

    bool has(const KnobSpec& knob) const;
    /// Nothing but cloud layers: knobs of rows do not matter.
    bool is_layer_alone() const { return has_layers && !has_surfaces && !has_volumes; }
};
SweepSubject sweep_subject(const EffectTable& effects, const formats::Scene& scene,
                           std::span<const PlanEntry> plan, const Knobs& knobs);

/// True if both give the same transport; knobs of effects that are not simulated do not count.
bool same_bake(const Knobs& a, const Knobs& b, const SweepSubject& subject);

/// Input of make_ladders and make_truths.
struct LadderRequest {
    const EffectTable& effects;
    const SweepSubject& subject;
    const BakeOptions& options;  ///< effects and seed go into every point
    /// What the base's plan chose (list_choices): the truths choose the same, where that is one
    /// word.
    std::string choices{};
};

/// Presets, every choice in the three cheaper presets, one-at-a-time ladders around the preset
/// `base`, and joint ladders, without the knobs of effects that the scene does not call for.
std::vector<SweepPoint> make_ladders(const LadderRequest& request, Quality base);

/// Candidates for the truth, the finest first.
std::vector<SweepPoint> make_truths(const LadderRequest& request);

}  // namespace opaline::bake
