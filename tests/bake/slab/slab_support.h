#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/scattering/gauss_legendre.h"
#include "bake/scattering/phase_series.h"
#include "bake/slab/solve_slab.h"

namespace opaline::tests {

inline bake::SlabMedium henyey_greenstein_slab(double g, double albedo) {
    return {bake::expand_henyey_greenstein(g, 400).lambda, albedo};
}

inline double cosine_of_degrees(double angle) {
    return std::cos(angle * std::numbers::pi / 180);
}

inline bake::SlabSolution solve_one(const bake::SlabMedium& medium, double depth, double cosine,
                                    unsigned orders = 0, int streams = 48) {
    return solve_slab(medium, {depth, 0, {cosine}, streams, orders}).front();
}

/// The integral of f over [from, to] by Gauss-Legendre rules on even pieces.
template <class Function>
double integrate(const Function& f, double from, double to, int pieces = 8, int nodes = 32) {
    const bake::GaussLegendre rule = bake::make_gauss_legendre(nodes);
    double sum = 0;
    for (int piece = 0; piece < pieces; ++piece) {
        for (std::size_t i = 0; i < rule.node.size(); ++i) {
            const double width = (to - from) / pieces;
            sum += rule.weight[i] * width * f(from + (piece + rule.node[i]) * width);
        }
    }
    return sum;
}

}  // namespace opaline::tests
