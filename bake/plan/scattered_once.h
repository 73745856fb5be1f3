#pragma once

#include "formats/scene.h"

namespace opaline::bake {

/// The share of light scattered once in the reflectance of a half space under uniform light,
/// largest over the bands; in [0, 1].
double share_scattered_once(const formats::Medium& medium);

/// Of all that light the relative RMS that so many terms of the phase function, seen as harmonics
/// of the view, leave wrong (phase_rms_relative); `terms` in [0, 25].
double once_error(const formats::Medium& medium, unsigned terms);

}  // namespace opaline::bake
