#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

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

}  // namespace opaline::tests
