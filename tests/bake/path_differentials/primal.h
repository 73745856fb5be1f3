#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>

namespace opaline::tests {

/// A number and its derivative: what is computed with it is differentiated by the chain rule alone,
/// without the algebra that it serves to check. Comparisons are of values.
struct Dual {
    double value = 0, change = 0;

    Dual() = default;
    Dual(double v, double d = 0) : value(v), change(d) {}  // NOLINT: constants mix with it

    friend Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.change + b.change}; }
    friend Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.change - b.change}; }
    friend Dual operator-(Dual a) { return {-a.value, -a.change}; }
    friend Dual operator*(Dual a, Dual b) {
        return {a.value * b.value, a.change * b.value + a.value * b.change};
    }
    friend Dual operator/(Dual a, Dual b) {
        const double ratio = a.value / b.value;
        return {ratio, (a.change - ratio * b.change) / b.value};
    }
    friend bool operator<(Dual a, Dual b) { return a.value < b.value; }
    friend bool operator>(Dual a, Dual b) { return a.value > b.value; }
    friend bool operator==(Dual a, Dual b) { return a.value == b.value; }
    friend Dual sqrt(Dual a) {
        const double root = std::sqrt(a.value);
        return {root, a.change / (2 * root)};
    }
    friend Dual exp(Dual a) { return {std::exp(a.value), a.change * std::exp(a.value)}; }
    friend Dual log(Dual a) { return {std::log(a.value), a.change / a.value}; }
    friend Dual sin(Dual a) { return {std::sin(a.value), a.change * std::cos(a.value)}; }
    friend Dual cos(Dual a) { return {std::cos(a.value), -a.change * std::sin(a.value)}; }
    friend Dual abs(Dual a) { return a.value < 0 ? -a : a; }
};

/// A vector of any scalar.
template <class S>
struct Vector {
    S x{}, y{}, z{};

    Vector() = default;
    Vector(S a, S b, S c) : x(a), y(b), z(c) {}
    Vector(const glm::dvec3& v) : x(v.x), y(v.y), z(v.z) {}  // NOLINT: constants mix with it

    friend Vector operator+(Vector a, Vector b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend Vector operator-(Vector a, Vector b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend Vector operator*(S s, Vector a) { return {s * a.x, s * a.y, s * a.z}; }
};

template <class S>
S dot(Vector<S> a, Vector<S> b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class S>
Vector<S> cross(Vector<S> a, Vector<S> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class S>
S length(Vector<S> a) {
    using std::sqrt;
    return sqrt(dot(a, a));
}
template <class S>
Vector<S> normalized(Vector<S> a) {
    return (S(1) / length(a)) * a;
}

/// a + x da: how a perturbed input moves.
template <class S>
Vector<S> moved(const glm::dvec3& a, const glm::dvec3& da, S x) {
    return Vector<S>(a) + x * Vector<S>(da);
}

inline glm::dvec3 values(const Vector<double>& v) {
    return {v.x, v.y, v.z};
}
inline glm::dvec3 values(const Vector<long double>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
inline glm::dvec3 values(const Vector<Dual>& v) {
    return {v.x.value, v.y.value, v.z.value};
}
inline glm::dvec3 changes(const Vector<Dual>& v) {
    return {v.x.change, v.y.change, v.z.change};
}

/// d f(x) / dx at 0 of a function that returns a vector, by dual numbers.
template <class F>
glm::dvec3 derivative(F&& f) {
    return changes(f(Dual(0, 1)));
}

/// The same by central differences, in extended precision: the step errs by its square alone.
template <class F>
glm::dvec3 central_difference(F&& f, long double h = 1e-6L) {
    return values((1 / (2 * h)) * (f(h) - f(-h)));
}

/// Largest errors of columns, relative to the largest component of the derivative by dual numbers.
struct ColumnErrors {
    double dual = 0, difference = 0;
    bool finite = true;

    template <class F>
    void add(F&& f, const glm::dvec3& column) {
        const glm::dvec3 exact = derivative(f);
        const auto largest = [](const glm::dvec3& v) {
            return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
        };
        const double size = std::max(largest(exact), 1e-12);
        finite = finite && std::isfinite(largest(column));
        dual = std::max(dual, largest(column - exact) / size);
        difference = std::max(difference, largest(column - central_difference(f)) / size);
    }
};

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
