#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/plan/knob.h"
#include "formats/opal/result.h"

namespace opaline::bake {

struct EffectTable;

/// Accuracy presets: each names a set of knobs.
enum class Quality { draft, preview, production, reference };

inline constexpr std::uint32_t kAllCoefficients = 0xffffffffu;

/// Values of effects' knobs: few, in no order.
struct KnobValues {
    struct Value {
        const KnobSpec* knob;
        double value;

        bool operator==(const Value&) const = default;
    };
    std::vector<Value> values;

    const double* find(const KnobSpec& knob) const;
    void set(const KnobSpec& knob, double value);
};

/// Whether receivers are added between those of the scene (bake/refine).
struct RefineChoice {
    enum class Mode {
        off,
        where_light_changes,  ///< as far as the quality, or the target error, asks for
        edges                 ///< all edges that are longer than longest_edge
    } mode = Mode::off;
    double longest_edge = 0;          ///< [m], > 0 for `edges`
    std::uint64_t max_receivers = 0;  ///< of all meshes, where any are added; 0: as the quality
};

/// The user's options. 0 means: as the quality preset.
struct BakeOptions {
    Quality quality = Quality::preview;
    /// target relative RMS error in [1e-4, 1); selects the knobs that are not given. 0: none
    double error = 0;
    std::uint32_t cubemap_size = 0;  ///< N: power of two in [8, 128]
    std::uint32_t coefficients = 0;  ///< M per row, the six face averages included; >= 7, or
                                     ///< kAllCoefficients
    KnobValues given;                ///< knobs of effects
    bool separate_terms = false;     ///< rows that all views share apart from the others
    bool simplify = true;            ///< vertices of one place and one normal share their rows
    /// names of the only effects to simulate; empty: as the planner decides
    std::vector<std::string> effects;
    bool simulate_all = false;  ///< every effect that concerns a subject, however little it
                                ///< contributes, and no shortcut
    bool check_model = false;   ///< also measure the model's error against Monte Carlo
    RefineChoice refine = {};
    std::uint64_t seed = 0;  ///< of everything random
    unsigned threads = 0;    ///< 0: one per core; never changes the result

    void set(const KnobSpec& knob, double value) { given.set(knob, value); }
};

/// The resolved knobs: every knob has its value.
struct Knobs {
    Quality quality = Quality::preview;  ///< the preset that the others started from
    std::uint32_t cubemap_size = 16;
    std::uint32_t coefficients = 128;
    std::uint32_t code_bits = 8;  ///< of the stored detail coefficients
    bool exact_rays = false;      ///< nothing is shared between receivers or samples: no light maps
    bool separate_terms = false;
    bool simplify = true;
    std::vector<std::string> effects;
    bool looks_inside_media = true;  ///< some effect that acts inside media is wanted
    bool simulate_all = false;
    bool check_model = false;
    RefineChoice refine = {};
    std::uint64_t seed = 0;
    /// Relative RMS that model and numerical error may have together; 0: none, otherwise the pilot
    /// changes what the user did not give.
    double error_target = 0;
    double model_error = 0;  ///< relative RMS that the models taken err by: the worst subject's
    bool cubemap_given = false, coefficients_given = false;
    KnobValues values;                   ///< of all effects
    std::vector<const KnobSpec*> given;  ///< those that the user gave

    /// The preset's where it was not set.
    double operator[](const KnobSpec& knob) const;
    void set(const KnobSpec& knob, double value);
    bool is_given(const KnobSpec& knob) const;
    /// What the models leave of error_target to the numerical error, half of it at least. Models
    /// that err by more than the target miss it however fine the numbers are: these may then err by
    /// half as much as the models, which adds an eighth to the error.
    double numerical_target() const;
};

/// The value of an integer knob.
std::uint32_t whole(const Knobs& knobs, const KnobSpec& knob);

/// Number of coefficients with which a file is expected to err by about `target` under the test
/// lights: where a pilot starts.
std::uint32_t expected_coefficients(double target);

/// Coefficients that each surface sample and each cluster keeps: half of a row's when rows have
/// 1024 or more, which adds little error and halves the memory (tests/bench/RESULTS.md).
std::uint32_t sample_coefficients(const Knobs& knobs);

/// Fills in the quality's values; refuses impossible ones (usage error).
formats::Result<Knobs> resolve_knobs(const EffectTable& effects, const BakeOptions& options);

/// The knobs of a bake whose models err by `error`, where the pilot begins: a target that they miss
/// costs no more than one that they can meet.
Knobs with_model_error(const EffectTable& effects, Knobs knobs, double error);

/// Applies the limits between knobs: no cube map finer than the asset's, `all` where as many
/// coefficients are asked for as there are.
Knobs settle(Knobs knobs);

std::string_view quality_name(Quality quality);

}  // namespace opaline::bake
