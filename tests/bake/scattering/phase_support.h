#pragma once

#include <utility>
#include <vector>

#include "formats/scene.h"

namespace opaline::tests {

inline formats::PhaseFunction hg(double g) {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::henyey_greenstein;
    phase.g = static_cast<float>(g);
    return phase;
}

inline formats::PhaseFunction rayleigh() {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::rayleigh;
    return phase;
}

inline formats::PhaseFunction gaussian(float rms_angle) {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::gaussian;
    phase.rms_angle = rms_angle;
    return phase;
}

/// `value` up to a factor.
inline formats::PhaseFunction table_of(std::vector<float> cosine, std::vector<float> value) {
    formats::PhaseFunction phase;
    phase.type = formats::PhaseFunction::Type::tabulated;
    phase.cosine = std::move(cosine);
    phase.value = std::move(value);
    return phase;
}

}  // namespace opaline::tests
