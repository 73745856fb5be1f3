#include "bake/effects/multiple/walks/exit_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "bake/scattering/fresnel.h"
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

float at(glm::vec4 lobe, glm::vec3 w) {
    return lobe.x + glm::dot(glm::vec3(lobe.y, lobe.z, lobe.w), w);
}

TEST(ExitLobe, AveragesToOneOverExitsAndSeesLinearLightAsTheExitDoes) {
    const glm::vec3 normal(0, 1, 0), gradient(0.3f, -0.7f, 0.5f);
    for (const double eta : {0.8, 1.0, 1.3, 1.8}) {
        const ExitLobe lobe = make_exit_lobe(eta);
        const glm::vec3 seen = glm::normalize(glm::vec3(0.2f, 0.7f, -0.4f));
        glm::vec4 mean(0);
        double light = 0;
        visit_exits(eta, [&](glm::vec3 w, double weight) {
            mean += static_cast<float>(weight) * lobe.eval(normal, w);
            light += weight * static_cast<double>(at(lobe.eval(normal, seen), w) *
                                                  (2 + glm::dot(gradient, w)));
        });
        EXPECT_NEAR(static_cast<double>(mean.x), 1, 4e-3) << eta;
        EXPECT_NEAR(static_cast<double>(glm::length(glm::vec3(mean.y, mean.z, mean.w))), 0, 4e-3)
            << eta;
        EXPECT_NEAR(light, static_cast<double>(2 + glm::dot(gradient, seen)), 4e-3) << eta;
    }
}

// The radiance that leaves a conservative half space toward the cosine c is Chandrasekhar's H(c) in
// proportion, of which the two moments are 2 / sqrt 3 and 0.82035 (Chandrasekhar 1960, table XI,
// isotropic scattering, albedo 1: alpha_1 and alpha_2).
TEST(ExitLobe, OfLightScatteredOftenIsThatOfAConservativeHalfSpace) {
    const ExitLobe lobe = make_exit_lobe(1);
    EXPECT_NEAR(lobe.diffuse, 0.82035 / (2 / std::sqrt(3.0)), 3e-3);
    const glm::vec3 normal(0, 0, 1);
    glm::vec4 mean(0);
    double weights = 0;
    visit_exits(1, [&](glm::vec3 w, double weight) {
        weight *= 2.0 / 3 + static_cast<double>(w.y);
        weights += weight;
        mean += static_cast<float>(weight) * lobe.eval(normal, {w.x, -w.z, w.y});
    });
    mean /= static_cast<float>(weights);
    EXPECT_NEAR(static_cast<double>(glm::length(mean - lobe.eval_diffuse(normal, {}))), 0, 5e-3);
}

// The lobe of a walk's way and length is the mean of the lobes of directions: over exits, the two
// have the same product with the way.
TEST(ExitLobe, OfLightScatteredOftenRemembersTheWayOfTheWalk) {
    const glm::vec3 up(0, 1, 0);
    constexpr std::uint32_t kWalks = 20000;
    for (const float eta : {1.0f, 1.3f, 1.7f}) {
        const ExitLobe lobe = make_exit_lobe(static_cast<double>(eta));
        const auto slab = tests::make_walked_body(tests::make_wide_slab(40),
                                                  tests::make_forward_medium(1, 0.98f, 0, eta));
        double directions = 0, ways = 0;
        std::vector<WalkExit> exits;
        WalkCounts counts;
        for (std::uint32_t w = 0; w < kWalks; ++w) {
            WalkRandom random({1, RandomStage::body_walk, 7, w});
            exits.clear();
            follow_walk(slab->space, {}, tests::start_below({0, 0, 0}, up), {2}, random, exits,
                        counts);
            for (const WalkExit& exit : exits) {
                if (exit.is_diffuse && exit.normal.y > 0.5f) {
                    const glm::vec4 way(0, exit.drift.x, 0, exit.drift.z);
                    const float weight = exit.weight[0];
                    directions +=
                        static_cast<double>(weight * glm::dot(way, lobe.eval(up, exit.direction)));
                    ways += static_cast<double>(weight *
                                                glm::dot(way, lobe.eval_diffuse(up, exit.drift)));
                }
            }
        }
        EXPECT_NEAR(ways / directions, 1, 0.15) << eta;
    }
}

TEST(ExitLobe, OfAnExitBehindTheSampleIsEven) {
    EXPECT_EQ(make_exit_lobe(1.3).eval({0, 1, 0}, {0.6f, -0.8f, 0}), glm::vec4(1, 0, 0, 0));
}

SurfaceSample make_sample(glm::vec3 position, glm::vec3 normal) {
    SurfaceSample sample{};
    sample.position = position;
    sample.normal = sample.geometric_normal = normal;
    sample.area = 1;
    return sample;
}

// Two sides of a sheet thinner than the spacing of its samples.
TEST(ExitLight, FindsTheNearestSampleThatFacesAsTheExitDoes) {
    const std::vector<SurfaceSample> samples{
        make_sample({0, 0, 0}, {0, 1, 0}), make_sample({0.4f, -0.1f, 0}, {0, -1, 0}),
        make_sample({1, 0, 0}, {0, 1, 0}), make_sample({50, 0, 0}, {0, 1, 0})};
    const SparseVectors none;
    const ExitLight light(samples, none, nullptr, 1.3, 0.9);
    std::vector<std::uint32_t> around;
    const auto nearest = [&](glm::vec3 position, glm::vec3 normal) {
        WalkExit exit;
        exit.position = position;
        exit.normal = normal;
        return light.nearest(exit, around);
    };
    EXPECT_EQ(nearest({0.4f, -0.01f, 0}, {0, 1, 0}), 0u);
    EXPECT_EQ(nearest({0.4f, -0.01f, 0}, {0, -1, 0}), 1u);
    EXPECT_EQ(nearest({0.9f, 0, 0}, {0, 1, 0}), 2u);
    EXPECT_EQ(nearest({300, 0, 0}, {0, 1, 0}), 3u) << "far from all";
    EXPECT_EQ(nearest({1, 0, 0}, {1, 0, 0}), 2u) << "none faces that way";
}

}  // namespace
}  // namespace opaline::bake
