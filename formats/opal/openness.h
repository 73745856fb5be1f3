#pragma once

#include <cstdint>

#include "formats/opal/vec3.h"

namespace opaline::formats {

/// How much of its surroundings a receiver sees, for what the asset has no transport of: mirrored
/// light. Four bytes a vertex, stored as is; all zeros: sees nothing.
struct Openness {
    std::int8_t axis[2] = {0, 0};  ///< mean unoccluded direction, octahedral, in steps of 1 / 127
    std::uint8_t fraction = 0;     ///< cosine-weighted share of the hemisphere, in 1 / 255
    std::uint8_t reserved = 0;
};
static_assert(sizeof(Openness) == 4);

/// `axis`: any length but 0, which is taken for +Z; off by at most 1 degree afterwards, exact
/// along the axes. `fraction` is clamped to [0, 1]; rounded, but only 1 becomes 255 and only 0
/// becomes 0: both mean something exact.
Openness encode_openness(Vec3 axis, float fraction);

/// Unit.
Vec3 open_axis(Openness openness);

/// In [0, 1].
inline float open_fraction(Openness openness) {
    return static_cast<float>(openness.fraction) / 255.0f;
}

}  // namespace opaline::formats
