#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/bake_plan.h"
#include "bake/plan/knobs.h"
#include "formats/scene.h"

namespace opaline::bake {

/// A family of settings that differ in one thing, or together in several.
enum class Ladder {
    preset,         ///< draft, preview, production, reference
    cubemap,        ///< N, all else as in the base
    resolution,     ///< N with all coefficients in 16 bits: what N alone costs in accuracy
    coefficients,   ///< M
    code_bits,      ///< of the stored coefficients
    samples,        ///< on the surface of each medium
    tolerance,      ///< of the hierarchical gather
    depth_samples,  ///< of single scattering
    phase_terms,    ///< K; anisotropic media only
    single_cubemap,
    exact_rays,        ///< 0: light maps and shared rays, 1: neither
    grid,              ///< N and M together
    diagonal,          ///< all knobs together, step by step
    reference_samples  ///< of the Monte Carlo reference, which is no bake: no point stands on it
};

/// "coefficients": as in tables and files.
std::string_view ladder_name(Ladder ladder);

/// A point's place on a ladder: `value` is the knob's, or 0 to 3 for presets, N for grids, and the
/// step for the diagonal. All coefficients count as as many as there are.
struct Rung {
    Ladder ladder;
    double value = 0;
};

/// One setting to bake with. No two points of a list make the same bake: what stands on several
/// ladders has several rungs; the truth may stand on none.
struct SweepPoint {
    std::string label;  ///< "preview", "M = 256": as its first rung says
    std::vector<Rung> rungs;
    Knobs knobs;
};

/// Which knobs matter to a scene.
struct SweepSubject {
    bool direct = false, multiple = false, single = false;  ///< some material has the effect
    bool anisotropic = false;  ///< and its phase function needs several terms
};
SweepSubject sweep_subject(const std::vector<PlanEntry>& plan, const formats::Scene& scene);

/// True if they make the same transport of a scene: knobs of effects that it does not call for do
/// not count.
bool same_bake(const Knobs& a, const Knobs& b, const SweepSubject& subject);

/// Presets, one-at-a-time ladders around the preset `base`, and joint ladders, without the knobs of
/// effects that the scene does not call for. `effects` and `seed` of `options` go into every point.
std::vector<SweepPoint> make_ladders(const SweepSubject& subject, const BakeOptions& options,
                                     Quality base);

/// Candidates for what the others are measured against, the finest first.
std::vector<SweepPoint> make_truths(const SweepSubject& subject, const BakeOptions& options);

}  // namespace opaline::bake
