#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/check/measure_error.h"
#include "bake/effects/rows/subject_states.h"
#include "bake/plan/knobs.h"

namespace opaline::bake {

/// The pilot's error plus one standard error.
double likely_error(const ErrorBounds& bounds);

/// An upper bound for the self-check, which uses other receivers: the pilot's error plus two
/// standard errors of the difference.
double sure_error(const ErrorBounds& bounds);

/// Index of the encoding to take, given the errors of all, cheapest first. Takes the first that
/// meets the target with a margin of two standard errors. If none does, takes the first that is
/// close to the most accurate; if that does not even meet the target with one standard error, the
/// first that is likely to. (More coefficients cost bytes only; other knobs cost time.)
/// Precondition: not empty.
std::size_t choose_encoding(std::span<const ErrorBounds> errors, double target);

/// Input of a pilot: a bake whose subjects have been studied.
struct PilotScene {
    const BakeInputs& bake;
    std::vector<SubjectState>& subjects;  ///< trials prepare them anew
    std::span<const TestLight> lights;    ///< of the cube map size at hand
    const Context& context;
};

/// A receiver with its true luminance under each test light.
struct PilotReceiver {
    std::uint32_t receiver = 0, material = 0;
    TwoEstimates truth;
};

inline constexpr std::size_t kLeastPilotReceivers = 64, kMostPilotReceivers = 1024,
                             kReceiversPerPilotReceiver = 40;
/// Of those, where the truth is expensive.
inline constexpr std::size_t kMostExpensivePilotReceivers = 192;

/// Some of the receivers, drawn apart from those of the self-check. Receivers of subjects whose
/// rows are black are left out. Fewer if cancelled.
std::vector<PilotReceiver> find_pilot_truth(const PilotScene& pilot, const Knobs& knobs);

/// How rows are kept.
struct Encoding {
    std::uint32_t coefficients = 0, code_bits = 8;

    bool operator==(const Encoding&) const = default;
};
inline constexpr Encoding kUnencoded{kAllCoefficients, 16};

/// Whether rows of the subject depend on knobs that a pilot tries, besides cube map and encoding.
/// The rows of others are gathered once for each size of the cube map.
bool depends_on_trials(const BakeInputs& bake, const SubjectState& subject);

/// Pairs of the receivers whose rows depend on no trial, for each encoding.
struct FixedPairs {
    std::vector<Encoding> encodings;
    /// Of each encoding: one for each light, receiver by receiver, the others left out.
    std::vector<std::vector<CheckedPair>> pairs;

    /// Precondition: it is one of them.
    const std::vector<CheckedPair>& of(const Encoding& encoding) const {
        const auto at = std::find(encodings.begin(), encodings.end(), encoding);
        return pairs[static_cast<std::size_t>(at - encodings.begin())];
    }
};

/// With all coefficients and with all encodings that may be chosen.
FixedPairs measure_fixed(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                         const Knobs& knobs);

/// Error of the fixed receivers with all coefficients, as a share of what all receivers send out
/// (relative RMS): only a finer cube map lowers it.
double find_fixed_floor(const FixedPairs& fixed, std::span<const PilotReceiver> receivers);

/// One tried value of one knob; the others at their finest or as already chosen.
struct PilotTrial {
    std::string knob;  ///< as in knobs_json
    double value = 0;  ///< kAllCoefficients: all
    double error = 0;  ///< relative RMS
    std::uint32_t code_bits = 16;
};

/// Result of a pilot for a cube map and the present samples.
struct PilotChoice {
    Knobs knobs;              ///< the cheapest that meet the target; if none do, the cheapest whose
                              ///< error is hardly above that of the finest
    double error = 0;         ///< expected, relative RMS
    double likely = 0;        ///< one standard error above that
    bool met = false;         ///< knobs.numerical_target() is likely met
    double finest_error = 0;  ///< with all coefficients and the finest knobs
    double smooth_error = 0;  ///< the same, of lights without suns
    std::vector<PilotTrial> trials{};
};

/// Tries, at the cube map size and with the samples as they are, the other knobs that the user did
/// not fix: effect by effect those of its pilot ladders, then coefficients and code bits. Measures
/// the error of each value, and takes the coarsest that leave it under the target. `fixed`:
/// measure_fixed of the same receivers and knobs.
/// Precondition: knobs.error_target > 0; the subjects' samples were taken with `knobs`.
PilotChoice choose_row_knobs(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                             const FixedPairs& fixed, const Knobs& knobs);

}  // namespace opaline::bake
