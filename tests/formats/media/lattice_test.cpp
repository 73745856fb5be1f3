#include "formats/media/lattice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::formats {
namespace {

const Lattice kLattice{5, 3, 100};

TEST(Lattice, OctavesAddUpWithTheirWeights) {
    const auto octaves = make_octaves(kLattice, 2, 7);
    const double first = eval_noise(make_noise(kLattice, 7), {1.3, 0.6});
    const double second = eval_noise(make_noise(finer(kLattice, 2), 8), {2.6, 1.2});
    EXPECT_NEAR(eval_octaves(octaves, 0.4, {1.3, 0.6}), first + 0.4 * second, 1e-12);
}

TEST(Lattice, DomesStayInTheirSquaresAndRepeat) {
    Lattice lattice{9, 8, 100, true, 0};
    for (int step = 0; step < 8; ++step) {
        lattice.turn = step * std::numbers::pi / 4;
        const Domes domes = make_domes(lattice, 3);
        for (const Domes::Dome& dome : domes.dome) {
            EXPECT_LE(std::max(std::abs(dome.x), std::abs(dome.y)), 0.425);
            EXPECT_NEAR(dome.height, 1, 0.2501);
        }
        double largest = 0;
        for (int i = 0; i < 500; ++i) {
            const LatticePoint p{0.137 * i, 0.0713 * i};
            const double height = eval_domes(domes, p);
            largest = std::max(largest, height);
            EXPECT_NEAR(eval_domes(domes, {p.x - 9, p.y + 16}), height, 1e-9);
            // No dome appears at once where others enter the neighbourhood.
            EXPECT_NEAR(eval_domes(domes, {p.x + 1e-6, p.y}), height, 1e-4);
        }
        EXPECT_GT(largest, 0.8);
        EXPECT_LT(largest, 1.3 * 1.25);
    }
}

TEST(Lattice, WhatTexelsCannotShowIsLeftOut) {
    const Lattice fine = finer({5, 3, 20}, 7);
    EXPECT_TRUE(fine.is_too_fine());
    EXPECT_TRUE(make_noise(fine, 1).slope.empty() && make_domes(fine, 1).dome.empty());
    EXPECT_EQ(eval_noise(make_noise(fine, 1), {3.2, 1.1}), 0);
    EXPECT_EQ(eval_domes(make_domes(fine, 1), {3.2, 1.1}), 0);
}

}  // namespace
}  // namespace opaline::formats
