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

}  // namespace opaline::formats
