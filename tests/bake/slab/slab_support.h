#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/gauss_legendre.h"
#include "bake/physics/phase_series.h"
#include "bake/physics/slab/slab_walk.h"
#include "bake/physics/slab/solve_slab.h"

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

/// Of estimates from their true values, in standard errors.
struct Deviations {
    double squares = 0, largest = 0;
    int count = 0;

    void add(double share, double standard_error, double truth) {
        if (standard_error > 0) {
            const double deviation = (share - truth) / standard_error;
            squares += deviation * deviation;
            largest = std::max(largest, std::abs(deviation));
            ++count;
        }
    }
    void add(const bake::SlabEstimate& estimate, double truth) {
        add(estimate.share, estimate.standard_error, truth);
    }
    void expect_normal(int least) const {
        EXPECT_GE(count, least);
        EXPECT_GT(std::sqrt(squares / count), 0.8);
        EXPECT_LT(std::sqrt(squares / count), 1.2);
        EXPECT_LT(largest, 4.5);
    }
};

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
