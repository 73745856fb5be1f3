#pragma once

#include <span>
#include <vector>

#include "bake/check/pilot/pilot.h"

namespace opaline::bake {

/// The encodings that a pilot may choose from, in order of bytes per row; with fixed coefficients,
/// only 8 and 16 bits.
std::vector<Encoding> list_encodings(const Knobs& knobs);

/// The pairs of all receivers under one encoding, receiver by receiver again: those that were
/// measured and the fixed ones. Precondition: `fixed` has the encoding.
std::vector<CheckedPair> insert_fixed(const PilotScene& pilot,
                                      std::span<const PilotReceiver> receivers,
                                      std::span<const CheckedPair> measured,
                                      const FixedPairs& fixed, const Encoding& encoding);

/// The receivers whose rows depend on trials, or those that do not.
std::vector<PilotReceiver> select_receivers(const PilotScene& pilot,
                                            std::span<const PilotReceiver> receivers,
                                            bool depend_on_trials);

}  // namespace opaline::bake
