#include "formats/opal/openness.h"

#include <algorithm>
#include <cmath>

namespace opaline::formats {
namespace {

float with_sign(float magnitude, float sign) {
    return sign < 0 ? -magnitude : magnitude;
}

std::int8_t code(float x) {
    return static_cast<std::int8_t>(std::lround(std::clamp(x, -1.0f, 1.0f) * 127.0f));
}

}  // namespace

Openness encode_openness(Vec3 axis, float fraction) {
    const float sum = std::abs(axis.x) + std::abs(axis.y) + std::abs(axis.z);
    const Vec3 d = sum > 0 && std::isfinite(sum) ? (1 / sum) * axis : Vec3{0, 0, 1};
    // The octahedron's lower half is folded over its diagonals.
    const float x = d.z < 0 ? with_sign(1 - std::abs(d.y), d.x) : d.x;
    const float y = d.z < 0 ? with_sign(1 - std::abs(d.x), d.y) : d.y;
    Openness openness;
    openness.axis[0] = code(x);
    openness.axis[1] = code(y);
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
    const float z = 1 - std::abs(x) - std::abs(y);
    if (z >= 0) return normalize({x, y, z});
    return normalize({with_sign(1 - std::abs(y), x), with_sign(1 - std::abs(x), y), z});
}

}  // namespace opaline::formats
