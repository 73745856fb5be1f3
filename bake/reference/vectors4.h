#pragma once

#include <cmath>
#include <glm/glm.hpp>

namespace opaline::bake {

/// Four numbers side by side.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

inline float sum4(Float4 v) {
    return (v[0] + v[1]) + (v[2] + v[3]);
}

inline bool any4(Int4 is_true) {
    return (is_true[0] | is_true[1] | is_true[2] | is_true[3]) != 0;
}

inline Float4 sqrt4(Float4 v) {
    return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}

/// Four vectors side by side.
struct Vectors4 {
    Float4 x{}, y{}, z{};

    glm::vec3 lane(std::size_t i) const { return {x[i], y[i], z[i]}; }
    void set_lane(std::size_t i, glm::vec3 v) { x[i] = v.x, y[i] = v.y, z[i] = v.z; }
};

inline Vectors4 operator+(const Vectors4& a, const Vectors4& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Vectors4 operator-(const Vectors4& a, const Vectors4& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Vectors4 operator*(Float4 s, const Vectors4& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Vectors4 operator*(float s, const Vectors4& a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Vectors4 operator*(Float4 s, glm::vec3 a) {
    return {s * a.x, s * a.y, s * a.z};
}
inline Float4 dot(glm::vec3 a, const Vectors4& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Float4 dot(const Vectors4& a, const Vectors4& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Vectors4 cross(glm::vec3 a, const Vectors4& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Vectors4 cross(const Vectors4& a, glm::vec3 b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

}  // namespace opaline::bake
