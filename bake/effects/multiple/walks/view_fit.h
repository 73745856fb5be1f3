#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/physics/fresnel.h"
#include "bake/physics/gauss_legendre.h"

namespace opaline::bake {

/// Rows for the dependence of walked light on the view, beside T_0: three of degree one, along the
/// axes, and five of degree two, of the harmonics Y_4 to Y_8.
inline constexpr std::uint32_t kFirstDegree = 3, kAllDegrees = 8;

/// Moments of directions w' inside, toward the eye, of walks that start as uniform light would
/// enter: with n the normal, c' = n . w', s^2 = 1 - c'^2, under the density p = F_t c / (pi c_exit)
/// of the direction outside. They make functions of degree one and two that are orthogonal under p
/// to one another and to 1 (README.md, "Views"):
///     c' - m,   t',   P_2(c') - a - b (c' - m),   (c' - q) t',   t' t'
/// the last without its trace, t' = w' - c' n.
struct ViewFit {
    double mean = 0;      ///< m, of c'
    double variance = 1;  ///< of c'
    double across = 1;    ///< mean square of each coordinate of t'
    double level = 0;     ///< a, mean of P_2(c')
    double slope = 0;     ///< b
    double bend = 1;      ///< mean square of P_2(c') - a - b (c' - m)
    double middle = 0;    ///< q = <c' s^2> / <s^2>
    double tilt = 1;      ///< <(c' - q)^2 s^2>
    double around = 1;    ///< <s^4>
    double steepest = 0;  ///< least c', 0 at index 1 and less
};

/// The mean under p of a function of c' and s^2, by quadrature. `eta` > 0 of the boundary.
template <class Function>
double mean_over_views(double eta, Function&& function) {
    const GaussLegendre rule = make_gauss_legendre(64);
    // Below eta = 1 nothing enters beyond the critical angle; the rule covers the rest.
    const double least = eta < 1 ? std::sqrt(1 - eta * eta) : 0;
    double sum = 0, all = 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
        const double c = least + (1 - least) * rule.node[i];
        const double p = rule.weight[i] * c * fresnel_transmittance(c, eta);
        const double inside = refracted_cosine(c, eta);
        all += p;
        sum += p * function(inside, 1 - inside * inside);
    }
    return sum / all;
}

/// `eta` > 0.
ViewFit make_view_fit(double eta);

/// P_2(c') - a - b (c' - m).
double bend_of(const ViewFit& fit, double cosine);

/// Contribution of a walk seen along `seen` to rows of degree one and two, for weight times light
/// of 1: the least-squares fit over walks. Its mean under p is 0. Both unit. `second`: also rows of
/// degree two, which are 0 otherwise.
using ViewLobe = std::array<float, kAllDegrees>;
ViewLobe eval_view_lobe(const ViewFit& fit, glm::vec3 normal, glm::vec3 seen, bool second);

/// How rows by view become spherical harmonics of w' (formats/README.md): harmonic k, seen with
/// Y_k(w'), is the sum over rows r of [k][r] * row r. What rows of degree two have of degree one
/// and 0 under p is taken out, so that T_0 stays the mean over views. `normal` unit.
using ViewMatrix = std::array<std::array<float, kAllDegrees>, kAllDegrees + 1>;
ViewMatrix to_harmonics(const ViewFit& fit, glm::vec3 normal);

/// B of Y_k(w) = w . B w, k = 4 to 8, symmetric and without trace.
glm::mat3 second_harmonic(std::uint32_t k);

}  // namespace opaline::bake
