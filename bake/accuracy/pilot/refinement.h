#pragma once

#include <optional>

#include "bake/plan/effect.h"

namespace opaline::bake {

/// What the best that a pilot can do with one cube map and one number of surface samples errs by:
/// with all coefficients and the finest other knobs. Relative RMS.
struct PilotRound {
    Knobs knobs;
    bool has_samples = false;  ///< a medium is gathered from surface samples
    double error = 0;
    double smooth_error = 0;  ///< of lights without suns: more texels hardly lower it, samples do
};

/// What the rounds so far have taught. A target may be out of reach whatever the knobs (a phase
/// function cut short by the user, a shadow's edge between two vertices): a knob that lowers the
/// error by less than a tenth, when samples are quadrupled or texels doubled, is not tried again.
struct Refinement {
    std::optional<PilotRound> base;  ///< the coarsest round that none tried since is worth its cost
    bool more_samples_help = true, more_texels_help = true;
    double texel_gain = 0;  ///< error after doubling the texels over that before; 0: not known yet
};

/// Learns from the next round, which is next_knobs of the last ones or the first. True: it is the
/// new base.
bool learn(Refinement& refinement, const PilotRound& round);

/// What to try next where the base did not meet its knobs' error_target: more surface samples or a
/// finer cube map, whichever the error comes from. Nothing: the user fixed them, they are at their
/// limit, they did not help, or not even the finest cube map would reach the target at the rate at
/// which the error falls. Precondition: there is a base.
std::optional<Knobs> next_knobs(const EffectTable& effects, const Refinement& refinement);

}  // namespace opaline::bake
