#pragma once

#include <vector>

#include "bake/base/stage_log.h"
#include "bake/check/pilot/pilot.h"
#include "formats/opal/result.h"

namespace opaline::bake {

/// Results of the pilot for a target error.
struct AccuracyReport {
    double target = 0;     ///< relative RMS asked for, of model and numerical error together
    double model = 0;      ///< of it the models', measured or estimated before the bake
    double numerical = 0;  ///< remaining share of numerical error
    double predicted = 0;  ///< expected numerical error of the chosen knobs, before the bake
    double likely = 0;     ///< `predicted` plus one standard error of the pilot
    bool met = false;      ///< expected to, and measured at receivers and between them
    struct Trial {
        Knobs knobs;  ///< of the round: cube map and samples
        PilotTrial trial;
    };
    std::vector<Trial> trials;
};

/// What choosing changes.
struct PilotState {
    std::vector<SubjectState>& subjects;
    std::vector<TestLight>& lights;
    StageLog& log;
    AccuracyReport& report;
};

/// The cheapest knobs whose error, as measured by the pilot, meets knobs.numerical_target(); knobs
/// of the user are kept. The subjects have been studied; they are left with the samples of the
/// chosen knobs, the lights with their cube map.
Knobs choose_knobs(const BakeInputs& bake, const Knobs& knobs, const Context& context,
                   PilotState state);

/// Says where the target was not reached. `measured`: by the self-check.
void warn_of_missed_target(const EffectTable& effects, const AccuracyReport& accuracy,
                           const Knobs& knobs, double measured,
                           std::vector<formats::Diagnostic>& warnings);

}  // namespace opaline::bake
