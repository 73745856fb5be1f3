#pragma once

#include <array>
#include <cmath>
#include <numbers>

#include "tests/bake/path_differentials/dual.h"

namespace opaline::tests {

/// What the columns are derivatives of, as textbooks write it, over any scalar.

template <class S>
std::array<S, 2> concentric_point(S u, S v) {
    using std::abs, std::cos, std::sin;
    const S a = S(2) * u - S(1), b = S(2) * v - S(1);
    if (a == S(0) && b == S(0)) {
        return {a, b};
    }
    const bool by_a = abs(a) > abs(b);
    const S r = by_a ? a : b, quarter = S(std::numbers::pi / 4);
    const S phi = by_a ? quarter * (b / a) : S(std::numbers::pi / 2) - quarter * (a / b);
    return {r * cos(phi), r * sin(phi)};
}

/// A direction whose cosine to the axis is c(q), q the squared radius of a point of the disk.
template <class S, class Cosine>
Vector<S> lobe_direction(std::array<S, 2> point, Cosine&& cosine) {
    using std::sqrt;
    const S q = point[0] * point[0] + point[1] * point[1];
    const S c = cosine(q), stretch = sqrt((S(1) - c * c) / q);
    return {stretch * point[0], stretch * point[1], c};
}

template <class S>
S power_cosine(double exponent, S q) {
    using std::exp, std::log;
    return exp(log(S(1) - q) / S(exponent + 1));
}

/// With xi = 1 - q; g != 0.
template <class S>
S henyey_greenstein_cosine(double g, S q) {
    const S f = S(1 - g * g) / (S(1 - g) + S(2 * g) * (S(1) - q));
    return (S(1 + g * g) - f * f) / S(2 * g);
}

template <class S>
Vector<S> mirrored(Vector<S> D, Vector<S> N) {
    return D - (S(2) * dot(D, N)) * N;
}

template <class S>
Vector<S> refracted(Vector<S> D, Vector<S> N, S eta) {
    using std::sqrt;
    const S k = dot(D, N);
    return eta * D - (eta * k + sqrt(S(1) - eta * eta * (S(1) - k * k))) * N;
}

/// Where P + t D meets the plane through Q.
template <class S>
S plane_distance(Vector<S> P, Vector<S> D, Vector<S> N, Vector<S> Q) {
    return dot(Q - P, N) / dot(D, N);
}

/// Where it first meets a sphere.
template <class S>
S sphere_distance(Vector<S> P, Vector<S> D, Vector<S> center, double radius) {
    using std::sqrt;
    const Vector<S> to = P - center;
    const S b = dot(to, D), a = dot(D, D), c = dot(to, to) - S(radius * radius);
    return (S(0) - b - sqrt(b * b - a * c)) / a;
}

template <class S>
Vector<S> in_frame(std::array<Vector<S>, 2> frame, Vector<S> axis, Vector<S> d) {
    return d.x * frame[0] + d.y * frame[1] + d.z * axis;
}

/// A normal of a GGX surface as w sees it, by a uniform cap [Dupuy2023].
template <class S>
Vector<S> visible_normal(Vector<S> w, double a_x, double a_y, std::array<S, 2> point) {
    using std::sqrt;
    const Vector<S> seen = normalized(Vector<S>{S(a_x) * w.x, S(a_y) * w.y, w.z});
    const S q = point[0] * point[0] + point[1] * point[1];
    const S z = S(1) - q * (S(1) + seen.z), s = sqrt((S(1) - z * z) / q);
    const Vector<S> h = Vector<S>{s * point[0], s * point[1], z} + seen;
    return normalized(Vector<S>{S(a_x) * h.x, S(a_y) * h.y, h.z});
}

}  // namespace opaline::tests
