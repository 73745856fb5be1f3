#include "bake/effects/multiple/walks/limit_views.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace opaline::bake {
namespace {

constexpr int kSteps = 64;  // of the cosine

// Proportional to the row's response to light that is equal in all texels: the first coefficient of
// each face is its mean.
float under_even_light(std::span<const float> row, std::uint32_t stride, std::uint32_t band) {
    const std::size_t face = row.size() / stride / 6;
    float sum = 0;
    for (std::size_t f = 0; f < 6; ++f) {
        sum += row[f * face * stride + band];
    }
    return sum;
}

// What rows by view make of even light, along the normal and across it.
struct EvenViews {
    double even = 0;       // of T_0
    double straight = 0;   // of (c' - m)
    glm::dvec3 across{0};  // of t'
    double bend = 0;       // of P_2(c') - a - b (c' - m)
    glm::dvec3 tilt{0};    // of (c' - q) t'
    double around = 0;     // the most of t' . D t' / s^2

    // The darkest of all azimuths.
    double least(const ViewFit& fit, double c, double first, double second) const {
        const double s2 = 1 - c * c, rest = c - fit.mean;
        return first * rest * straight + second * bend_of(fit, c) * bend -
               std::sqrt(s2) * glm::length(first * across + second * (c - fit.middle) * tilt) -
               second * s2 * around;
    }
    // The greatest factor of one part, beside another as it is, that leaves no view black.
    template <class Base, class Part>
    float most_of(const ViewFit& fit, Base&& base, Part&& part) const {
        double factor = 1;
        for (int i = 0; i <= kSteps; ++i) {
            const double c = fit.steepest + (1 - fit.steepest) * i / kSteps;
            const double left = std::max(0.0, even + base(c)), taken = -part(c);
            // Between steps a view may be darker by some 1e-4 of what it is here.
            constexpr double kBetween = 1.001;
            if (kBetween * taken > left) {
                factor = std::min(factor, left / (kBetween * taken));
            }
        }
        return static_cast<float>(factor);
    }
};

EvenViews even_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                     std::uint32_t band, glm::dvec3 normal) {
    const auto of = [&](std::size_t r) {
        return static_cast<double>(
            under_even_light(rows.subspan(r * row.size(), row.size()), stride, band));
    };
    EvenViews views;
    views.even = std::max(0.0, static_cast<double>(under_even_light(row, stride, band)));
    const glm::dvec3 first(of(0), of(1), of(2));
    views.straight = glm::dot(first, normal);
    views.across = first - views.straight * normal;
    if (rows.size() == kFirstDegree * row.size()) return views;
    glm::dmat3 form(0);
    for (std::uint32_t r = kFirstDegree; r < kAllDegrees; ++r) {
        form += of(r) * glm::dmat3(second_harmonic(r + 1));
    }
    const glm::dvec3 image = form * normal;
    views.bend = glm::dot(normal, image);
    views.tilt = 2.0 * (image - views.bend * normal);
    // What is left across the normal has no trace: its two values are opposite.
    const auto outer = [](glm::dvec3 a, glm::dvec3 b) { return glm::outerProduct(a, b); };
    const glm::dvec3 v = image - views.bend * normal;
    const glm::dmat3 flat = form - views.bend * outer(normal, normal) - outer(normal, v) -
                            outer(v, normal) +
                            0.5 * views.bend * (glm::dmat3(1) - outer(normal, normal));
    double squares = 0;
    for (int i = 0; i < 3; ++i) {
        squares += glm::dot(flat[i], flat[i]);
    }
    views.around = std::sqrt(0.5 * squares);
    return views;
}

}  // namespace

ViewLimit limit_views(std::span<const float> row, std::span<const float> rows, std::uint32_t stride,
                      glm::vec3 normal, const ViewFit& fit) {
    const std::uint32_t bands = stride == 1 ? 1 : 3;
    ViewLimit together, apart;
    for (std::uint32_t band = 0; band < bands; ++band) {
        const EvenViews views = even_views(row, rows, stride, band, glm::dvec3(normal));
        const auto none = [](double) { return 0.0; };
        const auto least = [&](double first, double second) {
            return [&views, &fit, first, second](double c) {
                return views.least(fit, c, first, second);
            };
        };
        together.first = std::min(together.first, views.most_of(fit, none, least(1, 1)));
        apart.first = std::min(apart.first, views.most_of(fit, none, least(1, 0)));
    }
    together.second = together.first;
    if (together.first >= apart.first) return together;
    for (std::uint32_t band = 0; band < bands; ++band) {
        const EvenViews views = even_views(row, rows, stride, band, glm::dvec3(normal));
        const auto first = [&](double c) {
            return views.least(fit, c, static_cast<double>(apart.first), 0);
        };
        const auto second = [&](double c) { return views.least(fit, c, 0, 1); };
        apart.second = std::min(apart.second, views.most_of(fit, first, second));
    }
    return apart;
}

}  // namespace opaline::bake
