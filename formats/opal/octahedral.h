#pragma once

#include <cmath>

#include "formats/opal/vec3.h"

namespace opaline::formats {

/// A direction as two values in [-1, 1]: the octahedron |x| + |y| + |z| = 1 seen from above, its
/// lower half folded over the diagonals.
struct Octahedral {
    float p = 0, q = 0;
};

/// `direction`: any length but 0, which is taken for +Z.
inline Octahedral to_octahedral(Vec3 direction) {
    const float sum = std::abs(direction.x) + std::abs(direction.y) + std::abs(direction.z);
    const Vec3 d = sum > 0 && std::isfinite(sum) ? (1 / sum) * direction : Vec3{0, 0, 1};
    if (d.z >= 0) return {d.x, d.y};
    return {d.x < 0 ? std::abs(d.y) - 1 : 1 - std::abs(d.y),
            d.y < 0 ? std::abs(d.x) - 1 : 1 - std::abs(d.x)};
}

/// Unit.
inline Vec3 from_octahedral(Octahedral at) {
    const float z = 1 - std::abs(at.p) - std::abs(at.q);
    if (z >= 0) return normalize({at.p, at.q, z});
    return normalize({at.p < 0 ? std::abs(at.q) - 1 : 1 - std::abs(at.q),
                      at.q < 0 ? std::abs(at.p) - 1 : 1 - std::abs(at.p), z});
}

}  // namespace opaline::formats
