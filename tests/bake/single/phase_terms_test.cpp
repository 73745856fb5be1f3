
#include <gtest/gtest.h>

#include <cmath>

#include "bake/effects/single/ray_single.h"
#include "tests/bake/single/grey_medium.h"
#include "tests/bake/single/single_support.h"

namespace opaline::bake {
namespace {

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
