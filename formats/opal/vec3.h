#pragma once

#include <cmath>

namespace opaline::formats {

/// A point, direction or normal; world space, right-handed, +Y up, metres where it is a length.
/// The file format and the runtime need no more than this; the baker uses GLM.
struct Vec3 {
    float x = 0, y = 0, z = 0;

    friend bool operator==(const Vec3&, const Vec3&) = default;
    friend Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vec3 operator*(float s, Vec3 a) { return {s * a.x, s * a.y, s * a.z}; }
};

inline float dot(Vec3 a, Vec3 b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vec3 cross(Vec3 a, Vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float length(Vec3 a) {
    return std::sqrt(dot(a, a));
}
/// Precondition: length(a) > 0.
inline Vec3 normalize(Vec3 a) {
    return (1.0f / length(a)) * a;
}

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
