#include "formats/opal/openness.h"

#include <algorithm>
#include <cmath>

#include "formats/opal/vec3.h"

namespace opaline::formats {
namespace {

std::int8_t code(float x) {
    return static_cast<std::int8_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 127.0f));
}

}  // namespace

Openness encode_openness(Vec3 axis, float fraction) {
    const Octahedral at = to_octahedral(axis);
    Openness openness;
    openness.axis[0] = code(at.p);
    openness.axis[1] = code(at.q);
    if (fraction >= 1) {
        openness.fraction = 255;
    } else if (fraction > 0) {
        openness.fraction =
            static_cast<std::uint8_t>(std::clamp(std::lround(fraction * 255.0f), 1l, 254l));
    }
    return openness;
}

Vec3 open_axis(Openness openness) {
    const float x = std::max(static_cast<float>(openness.axis[0]) / 127.0f, -1.0f);
    const float y = std::max(static_cast<float>(openness.axis[1]) / 127.0f, -1.0f);
    return from_octahedral({x, y});
}

}  // namespace opaline::formats
