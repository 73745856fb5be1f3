#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "bake/effects/single/ray_single.h"
#include "bake/physics/entry.h"
#include "bake/physics/path_quadrature.h"
#include "tests/bake/single/grey_medium.h"
#include "tests/bake/single/single_support.h"

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

using tests::gather;
using tests::make_grey_medium;
using tests::make_translucent_scene;
using tests::seen_from;
using tests::set_up;
using tests::SingleSetup;
using tests::vertex_at;

using tests::kIsotropic;

std::vector<float> henyey_greenstein_series(float g, std::size_t degrees) {
    std::vector<float> lambda{1};
    while (lambda.size() < degrees) {
        lambda.push_back(g * lambda.back());
    }
    return lambda;
}

// A box 2 wide and deep and `height` high, centred.
SingleSetup make_box(float height, const formats::Medium& medium, std::vector<float> lambda) {
    auto box = tests::make_cube(2, false);
    for (glm::vec3& v : box.position) {
        v.y *= 0.5f * height;
    }
    SingleSetup setup = set_up(make_translucent_scene({box}, medium));
    setup.medium.phase.lambda = std::move(lambda);
    return setup;
}

TEST(PhaseTerms, SumToTheTruncatedSeriesOfTheScatteringAngle) {
    const PhaseTerms phase{{1, 0.5f, -0.3f, 0.2f, 0.1f}};
    const glm::vec3 normal(0, 1, 0), w = glm::normalize(glm::vec3(0.4f, 0.7f, -0.2f));
    const Entry<float> entry = enter(w.y, Interface<float>{1.4f, true});
    std::vector<float> g(25), h(25);
    eval_phase_terms(phase, 1.4f, w, normal, entry, w.y, g);
    const glm::dvec3 inside = refracted_direction(w, normal, double{1.4f});
    for (const glm::vec3 o :
         {glm::vec3(0, 1, 0), glm::vec3(0.6f, 0, 0.8f), glm::normalize(glm::vec3(-1, 2, 0.5f))}) {
        formats::eval_spherical_harmonics({o.x, o.y, o.z}, h);
        const double cosine = -glm::dot(inside, glm::dvec3(o));  // between propagation directions
        double sum = 0, expected = 0;
        for (std::size_t k = 0; k < 25; ++k) {
            sum += double{g[k]} * double{h[k]};
        }
        for (unsigned l = 0; l < 5; ++l) {
            expected +=
                double{phase.lambda[l]} * (2 * l + 1) * kIsotropic * std::legendre(l, cosine);
        }
        EXPECT_NEAR(sum, expected, 2e-6);  // float polynomials
    }
    const std::vector<float> largest = largest_phase_terms(phase);
    for (std::size_t k = 0; k < 25; ++k) {
        EXPECT_LE(std::abs(g[k]), largest[k]) << k;
    }
}

// A half space under one direction: the path integral is sigma_s Ft J / (sigma_t (1 + 1 / c')),
// times the phase function between the refracted directions.
TEST(PhaseTerms, HalfSpaceAgreesWithTheTruncatedPhaseFunction) {
    constexpr float kG = 0.25f, kEta = 1.3f, kSigmaS = 90, kSigmaT = 100;
    auto setup = make_box(2, make_grey_medium(kSigmaS, kSigmaT - kSigmaS, kEta),
                          henyey_greenstein_series(kG, 2));
    setup.medium.rule = make_gauss_rule(64);
    const std::size_t top = vertex_at(setup, {0, 1, 0});
    for (const double cosine : {0.95, 0.6, 0.2}) {
        // Around a slanted axis every lane has a different angle.
        const DirectionSet cone =
            tests::make_cone(glm::normalize(glm::vec3(0.2f, 1, 0.1f)), cosine);
        const glm::dvec3 view = glm::normalize(glm::dvec3(0.5, 1, -0.2));
        double expected = 0;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const DirectionBlock& block = cone.blocks[0];
            const glm::dvec3 w(block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]);
            const Entry<double> e = enter(w.y, Interface<double>{double{kEta}, true});
            if (!(e.throughput > 0)) continue;
            const glm::dvec3 inside = refracted_direction(w, {0, 1, 0}, double{kEta});
            const double phase = kIsotropic * (1 - 3 * double{kG} * glm::dot(inside, view));
            expected += double{kSigmaS / kSigmaT} * e.throughput * phase /
                        (1 + 1 / e.refracted_cosine) / RayPacket::kSize;
        }
        const auto seen = seen_from(gather(setup, cone, top), 4, glm::vec3(view));
        EXPECT_NEAR(seen[0], expected, 1e-4 * expected) << cosine;
    }
}

}  // namespace

}  // namespace opaline::bake
