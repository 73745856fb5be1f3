#pragma once

#include <optional>

#include "bake/plan/effect.h"

namespace opaline::bake {

/// The lowest error for one cube map and one number of surface samples, with all coefficients and
/// the finest other knobs; relative RMS.
struct PilotRound {
    Knobs knobs;
    bool has_samples = false;  ///< a medium is gathered from surface samples
    double error = 0;
    double smooth_error = 0;  ///< of lights without suns: samples lower it, texels hardly
};

/// Results of the rounds so far. A target may be out of reach for any knobs (a phase function
/// truncated by the user, a shadow edge between two vertices). So a knob that lowers the error by
/// less than 10 %, with four times the samples or twice the texels, is not tried again.
struct Refinement {
    /// the best round so far; later rounds lowered the error by less than 10 %
    std::optional<PilotRound> base;
    bool more_samples_help = true, more_texels_help = true;
    /// ratio of the errors after and before doubling the texels; 0: unknown
    double texel_gain = 0;
};

/// Learns from the next round, which is next_knobs of the last ones or the first. True: it is the
/// new base.
bool learn(Refinement& refinement, const PilotRound& round);

/// The next knobs to try if the base did not meet its target: more surface samples or a finer
/// cube map, whichever causes the error. Nothing if the user fixed both, they are at their limits,
/// they did not help, or the error falls too slowly to reach the target with the finest cube map.
/// Precondition: there is a base.
std::optional<Knobs> next_knobs(const EffectTable& effects, const Refinement& refinement);

}  // namespace opaline::bake
