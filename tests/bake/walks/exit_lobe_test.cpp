#include "bake/effects/multiple/walks/exit_lobe.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "bake/physics/fresnel.h"
#include "tests/bake/walks/body_walks.h"

namespace opaline::bake {
namespace {

// Visits directions of the upper hemisphere with weights p dw, p = F_t c / (pi c_exit), of sum 1.
template <class Visit>
void visit_exits(double eta, Visit&& visit) {
    constexpr int kCosines = 400, kAzimuths = 64;
    double all = 0;
    const auto weight_of = [&](double c) { return c * fresnel_transmittance(c, eta); };
    for (int i = 0; i < kCosines; ++i) {
        all += kAzimuths * weight_of((i + 0.5) / kCosines);
    }
    for (int i = 0; i < kCosines; ++i) {
        const double c = (i + 0.5) / kCosines, s = std::sqrt(1 - c * c);
        for (int k = 0; k < kAzimuths; ++k) {
            const double angle = 2 * std::numbers::pi * (k + 0.5) / kAzimuths;
            visit(glm::vec3(s * std::cos(angle), c, s * std::sin(angle)), weight_of(c) / all);
        }
    }
}

WalkExit exit_along(glm::vec3 direction) {
    WalkExit exit;
    exit.direction = direction;
    return exit;
}

double light_of_degree_two(glm::vec3 w) {
    const glm::dvec3 d(w);
    return 2 + 0.3 * d.x - 0.7 * d.y + 0.5 * d.z + 0.8 * d.x * d.y - 0.6 * d.z * d.z +
           0.4 * d.x * d.z + 0.9 * d.y * d.y;
}

TEST(ExitLobe, SeesLightOfDegreeTwoAsTheExitDoesEvenAtGrazingAngles) {
    const glm::vec3 up(0, 1, 0);
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        const ExitLobe lobe = make_exit_lobe(eta);
        for (const glm::vec3 towards : {glm::vec3(0.2f, 0.9f, -0.2f), glm::vec3(0.5f, 0.7f, 0.4f),
                                        glm::vec3(0.9f, 0.01f, -0.4f)}) {
            const glm::vec3 seen = glm::normalize(towards);
            const LightFactor factor = lobe.eval(up, seen);
            double light = 0, even = 0;
            visit_exits(eta, [&](glm::vec3 w, double weight) {
                even += weight * factor.at(w);
                light += weight * factor.at(w) * light_of_degree_two(w);
            });
            EXPECT_NEAR(even, 1, 0.02) << eta;
            EXPECT_NEAR(light, light_of_degree_two(seen), 0.05) << eta;
        }
    }
}

TEST(ExitLobe, OfAnExitBelowTheHorizonIsEven) {
    const ExitLobe lobe = make_exit_lobe(1.3);
    const LightFactor factor = lobe.eval({0, 1, 0}, {0.6f, -0.8f, 0});
    EXPECT_EQ(factor.at({0.6, 0.8, 0}), 1);
    EXPECT_EQ(factor.at({0, 1, 0}), 1);
    const ExitDirection direction = lobe.direction({0, 1, 0}, exit_along({0.6f, -0.8f, 0}));
    EXPECT_NEAR(static_cast<double>(direction.mean.y), lobe.mean, 1e-6);
    EXPECT_NEAR(static_cast<double>(direction.square[1][1]), lobe.square, 1e-6);
}

// The radiance that leaves a conservative half space toward the cosine c is Chandrasekhar's H(c) in
// proportion, of which the two moments are 2 / sqrt 3 and 0.82035 (Chandrasekhar 1960, table XI,
// isotropic scattering, albedo 1: alpha_1 and alpha_2).
TEST(ExitLobe, OfLightScatteredOftenIsThatOfAConservativeHalfSpace) {
    const ExitLobe lobe = make_exit_lobe(1);
    EXPECT_NEAR(lobe.diffuse, 0.82035 / (2 / std::sqrt(3.0)), 3e-3);
    const glm::vec3 normal(0, 0, 1);
    glm::vec3 mean(0);
    glm::mat3 square(0);
    double weights = 0;
    visit_exits(1, [&](glm::vec3 w, double weight) {
        weight *= 2.0 / 3 + static_cast<double>(w.y);
        weights += weight;
        const ExitDirection direction = lobe.direction(normal, exit_along({w.x, -w.z, w.y}));
        mean += static_cast<float>(weight) * direction.mean;
        square += static_cast<float>(weight) * direction.square;
    });
    WalkExit often;
    often.turned = 1e6f;
    const ExitDirection diffuse = lobe.direction(normal, often);
    const auto all = static_cast<float>(weights);
    EXPECT_NEAR(static_cast<double>(glm::length(mean / all - diffuse.mean)), 0, 2e-3);
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(glm::length(square[i] / all - diffuse.square[i])), 0, 2e-3);
    }
}

// By how much the mean square of a direction along d, in the tangent plane, is above that across
// it, times |d|^2 / 2.
double square_along(glm::vec3 d, const glm::mat3& square) {
    return static_cast<double>(glm::dot(d, square * d) -
                               0.5f * glm::dot(d, d) * (square[0][0] + square[2][2]));
}

// A walk's way and length tell the mean of its exits' directions and of their squares: over exits,
// these have the same products with the way as the directions themselves.
TEST(ExitLobe, OfLightScatteredOftenRemembersTheWayOfTheWalk) {
    const glm::vec3 up(0, 1, 0);
    constexpr std::uint32_t kWalks = 20000;
    for (const float eta : {1.0f, 1.3f, 1.7f}) {
        const ExitLobe lobe = make_exit_lobe(static_cast<double>(eta));
        const auto slab = tests::make_walked_body(tests::make_wide_slab(40),
                                                  tests::make_forward_medium(1, 0.98f, 0, eta));
        double directions = 0, ways = 0, true_squares = 0, squares = 0;
        tests::visit_walks(
            slab->space, tests::start_below({0, 0, 0}, up), {2}, kWalks, [&](const auto& exits) {
                for (const WalkExit& exit : exits) {
                    if (!(exit.turned >= 1 && exit.normal.y > 0.5f)) continue;
                    const glm::vec3 along(exit.drift.x, 0, exit.drift.z);
                    const glm::vec3 way = exit.weight[0] * along;
                    const ExitDirection known = lobe.direction(up, exit);
                    directions += static_cast<double>(glm::dot(way, exit.direction));
                    ways += static_cast<double>(glm::dot(way, known.mean));
                    const auto weight = static_cast<double>(exit.weight[0]);
                    true_squares += weight * square_along(along, glm::outerProduct(exit.direction,
                                                                                   exit.direction));
                    squares += weight * square_along(along, known.square);
                }
            });
        EXPECT_NEAR(ways / directions, 1, 0.15) << eta;
        EXPECT_NEAR(squares / true_squares, 1, 0.45) << eta;
    }
}

}  // namespace
}  // namespace opaline::bake
