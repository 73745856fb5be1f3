#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "tests/bake/single/grey_medium.h"

namespace opaline::bake {
namespace {

using tests::grey;

TEST(PathRule, GaussIntegratesPolynomialsUpToTwiceItsCountExactly) {
    for (const std::uint32_t count : {1u, 2u, 5u, 8u, 16u, 64u}) {
        const PathRule rule = make_gauss_rule(count);
        for (std::uint32_t degree = 0; degree < 2 * count; ++degree) {
            double sum = 0;
            for (std::uint32_t i = 0; i < count; ++i) {
                sum += rule.weight[i] * std::pow(rule.position[i], degree);
            }
            EXPECT_NEAR(sum, 1.0 / (degree + 1), 1e-13) << count << " nodes, degree " << degree;
        }
        EXPECT_TRUE(std::is_sorted(rule.position.begin(), rule.position.end()));
    }
}

TEST(PathNodes, TinyPathIsItsLength) {
    // int_0^d sigma_s e^{-sigma_t s} ds -> sigma_s d, relative error sigma_t d / 2.
    for (const double d : {1e-6, 1e-12, 1e-300}) {
        for (const double sigma_m : {0.0, 1.0, 2.0}) {
            double sum = 0;
            for (const PathNode& node :
                 place_path_nodes(make_gauss_rule(8), grey(3, 2, sigma_m), d)) {
                EXPECT_GT(node.depth, 0);
                EXPECT_LT(node.depth, d);
                sum += node.weight[0];
            }
            EXPECT_NEAR(sum / (3 * d), 1, 2 * d + 1e-14) << d << ' ' << sigma_m;
        }
    }
}

TEST(PathNodes, NoPathHasNoNodes) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const double d : {0.0, -1.0, nan}) {
        EXPECT_TRUE(place_path_nodes(make_gauss_rule(8), grey(1, 1, 1), d).empty());
    }
    const double infinity = std::numeric_limits<double>::infinity();
    EXPECT_TRUE(place_path_nodes(make_gauss_rule(8), grey(1, 1, 0), infinity).empty());
}

TEST(PathNodes, EndlessPathIntegratesTheExponential) {
    const double infinity = std::numeric_limits<double>::infinity();
    double sum = 0;
    for (const PathNode& node : place_path_nodes(make_gauss_rule(8), grey(3, 5, 5), infinity)) {
        EXPECT_TRUE(std::isfinite(node.depth));
        sum += node.weight[0];
    }
    EXPECT_NEAR(sum, 3.0 / 5.0, 1e-14);
}

TEST(PathNodes, ChannelsOfAnyExtinctionAreAccurateWithTheSmallestAsDensity) {
    // e^{-2 sigma_c s} with sigma_c up to four times sigma_m is a polynomial of degree 7 in xi, and
    // 8 Gauss nodes take degree 15.
    const PathMedium medium{{1, 1, 1}, {1, 2, 4}, 1};
    for (const double d : {0.1, 1.0, 5.0, 30.0}) {
        std::array<double, 3> sum{};
        for (const PathNode& node : place_path_nodes(make_gauss_rule(8), medium, d)) {
            for (std::size_t c = 0; c < 3; ++c) {
                sum[c] += node.weight[c] * std::exp(-medium.sigma_t[c] * node.depth);
            }
        }
        for (std::size_t c = 0; c < 3; ++c) {
            const double k = 2 * medium.sigma_t[c];
            EXPECT_NEAR(sum[c], -std::expm1(-k * d) / k, 1e-12) << d << ' ' << c;
        }
    }
}

TEST(PathMedium, DensityIsTheThinnestChannelAndTheLuminanceOnPaper) {
    formats::Medium medium;
    medium.sigma_s = {0.75f, 0.85f, 1.0f};
    medium.sigma_a = {0.02f, 0.04f, 0.07f};
    EXPECT_NEAR(make_path_medium(medium).sigma_m, 0.77, 1e-7);
    medium.fidelity = formats::Medium::Fidelity::paper;
    EXPECT_NEAR(make_path_medium(medium).sigma_m, 0.877484, 1e-6);
}

TEST(PathMedium, PathsEndAtTheBodyOrWhereNothingIsLeft) {
    EXPECT_EQ(path_limit(grey(1, 2, 2), 5), 5);
    EXPECT_EQ(path_limit(grey(1, 20, 20), 5), 2);
    EXPECT_EQ(path_limit(grey(0, 0, 0), 5), 5);
}

TEST(Entry, ProductIsFresnelTimesJacobian) {
    for (const double eta : {0.4, 0.8, 0.999, 1.0, 1.001, 1.3, 1.5, 3.0}) {
        for (double c = 0.047; c <= 1; c += 0.05) {
            const Entry<double> e = enter(c, Interface<double>{eta, true});
            const double s2 = (1 - c * c) / (eta * eta);
            if (s2 >= 1) {
                EXPECT_EQ(e.throughput, 0) << eta << ' ' << c;
                continue;
            }
            const double t = std::sqrt(1 - s2);
            const double rs = (c - eta * t) / (c + eta * t), rp = (eta * c - t) / (eta * c + t);
            const double expected = (1 - (rs * rs + rp * rp) / 2) * c / (eta * eta * t);
            EXPECT_NEAR(e.throughput, expected, 1e-10 * expected) << eta << ' ' << c;
        }
    }
}

TEST(Entry, StaysFiniteJustInsideTheCriticalAngle) {
    // 6.41 at 0.8 and 9.64 at 0.67, although J is unbounded.
    for (const auto& [eta, expected] : {std::pair{0.8, 6.41}, {0.67, 9.64}}) {
        const double critical = std::sqrt(1 - eta * eta);
        const Entry<double> inside = enter(critical * (1 + 1e-12), Interface<double>{eta, true});
        EXPECT_NEAR(inside.throughput, expected, 0.01) << eta;
        EXPECT_GT(inside.path_ratio, 1e4);  // no light from there, even along a short path
        EXPECT_EQ(enter(critical * (1 - 1e-12), Interface<double>{eta, true}).throughput, 0);
    }
}

TEST(Entry, GrazingAndBackwardLightEnterNowhere) {
    for (const float eta : {0.8f, 1.0f, 1.3f}) {
        for (const float c : {0.0f, -0.0f, -0.5f, 1e-30f, std::nanf("")}) {
            const Entry<float> e = enter(c, Interface<float>{eta, true});
            EXPECT_TRUE(std::isfinite(e.throughput) && std::isfinite(e.path_ratio)) << eta << c;
            EXPECT_LT(e.throughput, eta == 1.0f ? 1.01f : 1e-20f) << eta << ' ' << c;
        }
    }
}

TEST(Entry, RefractedDirectionObeysSnell) {
    const glm::dvec3 n = glm::normalize(glm::dvec3(0.2, 0.9, -0.3));
    const glm::dvec3 w = glm::normalize(glm::dvec3(0.8, 0.5, 0.1));
    for (const double eta : {0.95, 1.0, 1.5}) {
        const glm::dvec3 inside = refracted_direction(w, n, eta);
        EXPECT_NEAR(glm::length(inside), 1, 1e-14);
        EXPECT_NEAR(glm::length(glm::cross(inside, n)) * eta, glm::length(glm::cross(w, n)), 1e-14);
        EXPECT_NEAR(glm::dot(inside, glm::cross(w, n)), 0, 1e-14);
    }
}

TEST(ExpOfNegative, AgreesWithTheLibrary) {
    for (float x = 0; x > -79.9f; x -= 0.0137f) {
        const double expected = std::exp(static_cast<double>(x));
        EXPECT_NEAR(exp_of_negative(x), expected, 3e-7 * expected) << x;
    }
    EXPECT_EQ(exp_of_negative(0), 1);
    EXPECT_EQ(exp_of_negative(-1e9f), 0);
    EXPECT_EQ(exp_of_negative(-std::numeric_limits<float>::infinity()), 0);
}

}  // namespace
}  // namespace opaline::bake
