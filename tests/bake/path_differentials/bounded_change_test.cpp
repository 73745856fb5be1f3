#include "bake/physics/path_differentials/bounded_change.h"
#include "bake/physics/path_differentials/axis_frame.h"
#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

// Hard case: 1 / (D.N_g).
TEST(BoundedChange, GrazingTransfersMoveByAtMost1e4) {
    const glm::dvec3 N(0, 0, 1);
    for (const double c : {1e-2, 1e-4, 1e-6, 1e-12, 0.0, -1e-6, -1e-2}) {
        const glm::dvec3 D(std::sqrt(1 - c * c), 0, c), dP(0.3, 0.2, 0.5), dD(0, 0, 0.1);
        const glm::dvec3 moved = bounded_transfer(D, N, 2, dP, dD);
        EXPECT_LE(glm::length(moved), 1e4 * (1 + 1e-9) * glm::length(dP + 2.0 * dD)) << c;
        EXPECT_EQ(moved.z, 0) << c;
    }
}

TEST(BoundedChange, SecantOfTheRootIsBoundedByTheRootOfTheChange) {
    for (const double z : {0.0, 1e-12, 1e-6, 0.01, 1.0}) {
        for (const double d : {1e-15, 1e-9, 1e-3, 0.5}) {
            EXPECT_LE(sqrt_secant(z, d), std::sqrt(d) * (1 + 1e-15));
            EXPECT_EQ(sqrt_secant(z, -d), -sqrt_secant(z, d));
            const long double lower = std::sqrt(std::max(0.0L, z - d / 2.0L));
            const double exact = static_cast<double>(std::sqrt(z + d / 2.0L) - lower);
            EXPECT_NEAR(sqrt_secant(z, d), exact, 1e-12 * exact + 1e-18);
        }
    }
    EXPECT_EQ(sqrt_secant(0, 0), 0);
    EXPECT_EQ(sqrt_secant(0.25, 0), 0);
}

// Hard case: |dT| = eta cos_i / cos_t, without bound towards the critical angle.
TEST(BoundedChange, RefractionNearTotalReflectionIsBoundedByItsSecant) {
    const double eta = 1.5, critical = std::sqrt(1 - 1 / (eta * eta));
    const glm::dvec3 N(0, 0, 1);
    double raw = 0;
    for (const auto& [e, expected] :
         {std::pair(1e-2, 7.12), {1e-4, 70.7}, {1e-6, 707}, {1e-8, 7071}}) {
        const double c = critical * (1 + e), s = std::sqrt(1 - c * c);
        const auto event = make_refraction({s, 0, -c}, N, eta);
        ASSERT_TRUE(event);
        const glm::dvec3 dD(c, 0, s), still(0);
        raw = glm::length(event->change(dD, still));
        EXPECT_NEAR(raw / expected, 1, 2e-3);
        for (const double step : {1e-3, 0.1, 1.0}) {
            const double delta =
                step *
                std::abs(event->square_cosine_change(event->mirror.cosine_change(dD, still)));
            const glm::dvec3 moved = step * bounded_refraction(*event, dD, still, step);
            EXPECT_TRUE(std::isfinite(moved.x));
            // The rest of dT, eta step |dD| (1 + |k|), is bounded by itself.
            EXPECT_LE(glm::length(moved), std::sqrt(delta) + 2 * eta * step);
        }
    }
    EXPECT_GT(raw, 7000);
}

TEST(BoundedChange, RefractionOfASmallStepIsItsDerivative) {
    tests::RandomInputs random(34);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 N = random.unit(), D = -random.unit_facing(N, 0.1);
        const glm::dvec3 dD = random.change_of(D), dN = random.change_of(N);
        const auto event = make_refraction(D, N, random.uniform(0.5, 0.95));
        ASSERT_TRUE(event);
        const glm::dvec3 exact = event->change(dD, dN);
        EXPECT_LT(glm::length(bounded_refraction(*event, dD, dN, 1e-5) - exact),
                  1e-8 * (1 + glm::length(exact)));
    }
}

TEST(BoundedChange, SecantsOfLobesTendToTheirDerivatives) {
    tests::RandomInputs random(35);
    for (const Lobe& lobe :
         {Lobe{Lobe::Kind::power, 1}, Lobe{Lobe::Kind::power, 40},
          Lobe{Lobe::Kind::henyey_greenstein, 0.7}, Lobe{Lobe::Kind::cone, 0.5}}) {
        for (int i = 0; i < 1000; ++i) {
            const double u = random.uniform(0.1, 0.9), v = random.uniform(0.1, 0.9);
            const LobeDirection exact = sample_lobe(lobe, u, v);
            const LobeDirection secant = secant_of_lobe(lobe, u, v, 1e-5);
            EXPECT_LT(glm::length(secant.dD_du - exact.dD_du), 1e-6);
            EXPECT_LT(glm::length(secant.dD_dv - exact.dD_dv), 1e-6);
            EXPECT_LT(glm::length(secant.D - exact.D), 1e-15);
            EXPECT_EQ(secant.dln_pdf_du, exact.dln_pdf_du);
            EXPECT_EQ(secant.dln_pdf_dv, exact.dln_pdf_dv);
        }
    }
}

// Hard case: where the density ends it is 0, and the derivative infinite. q = 0.99 has a radius of
// 0.995.
TEST(BoundedChange, RimOfALobeIsBoundedBy90Degrees) {
    for (const Lobe& lobe : {Lobe{Lobe::Kind::power, 1}, Lobe{Lobe::Kind::power, 40},
                             Lobe{Lobe::Kind::henyey_greenstein, 0.9}, Lobe{Lobe::Kind::cap, 2}}) {
        for (const double v : {0.995, 1 - 1e-6, 1 - 1e-12}) {
            for (const double step : {1e-3, 0.25, 1.0}) {
                const LobeDirection at = secant_of_lobe(lobe, 0.4, v, step);
                for (const glm::dvec3& column : {at.dD_du, at.dD_dv}) {
                    EXPECT_LE(step * glm::length(column), std::sqrt(2.0) + 1e-12);
                }
            }
        }
    }
    EXPECT_GT(glm::length(sample_lobe({Lobe::Kind::power, 40}, 0.4, 1 - 1e-12).dD_dv), 1e9);
}

TEST(BoundedChange, DirectionsAreShortenedAndKept) {
    EXPECT_EQ(bounded_direction({1, 0, 0}, 0.5), glm::dvec3(1, 0, 0));
    EXPECT_NEAR(0.5 * glm::length(bounded_direction({100, 0, 0}, 0.5)), std::sqrt(2.0), 1e-14);
}

TEST(AxisFrame, IsOrthonormalAndRightHanded) {
    tests::RandomInputs random(14);
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 n = random.unit();
        const glm::dmat3 frame = frame_around(n);
        EXPECT_LT(glm::length(glm::cross(frame[0], frame[1]) - n), 1e-14);
        EXPECT_LT(std::abs(glm::dot(frame[0], frame[1])), 1e-14);
    }
}

// d(R.D) = 0, D stays unit, and what turns is what a frame that turns by R x dR makes of it:
// Rodrigues' rotation by the angle |dR| x, differentiated by dual numbers.
TEST(AxisFrame, CarriedDirectionsTurnWithTheAxisAndDoNotSpin) {
    tests::RandomInputs random(15);
    tests::ColumnErrors errors;
    double along = 0, to_axis = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 R = random.unit(), dR = random.change_of(R), D = random.unit();
        const glm::dvec3 carried = carry_with_axis(R, dR, D);
        const double rate = glm::length(dR);
        const glm::dvec3 around = glm::cross(R, dR) / rate;
        errors.add(
            [&](auto x) {
                using S = decltype(x);
                using std::cos, std::sin;
                const S angle = S(rate) * x;
                const tests::Vector<S> axis(around), d(D);
                return cos(angle) * d + sin(angle) * tests::cross(axis, d) +
                       ((S(1) - cos(angle)) * tests::dot(axis, d)) * axis;
            },
            carried);
        along = std::max(along, std::abs(glm::dot(D, carried)));
        to_axis = std::max(to_axis, std::abs(glm::dot(dR, D) + glm::dot(R, carried)));
    }
    tests::expect_derivatives(errors);
    EXPECT_LT(along, 1e-12);
    EXPECT_LT(to_axis, 1e-12);
}

// Hard case: near its reference axis a frame whose T is perpendicular to one spins without bound.
TEST(AxisFrame, NearAReferenceAxisNothingDiverges) {
    for (const double angle : {1e-2, 1e-4, 1e-6}) {
        const glm::dvec3 R(std::sin(angle), 0, std::cos(angle)), dR(0, 0.1, 0);
        const glm::dvec3 D = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));
        EXPECT_LT(glm::length(carry_with_axis(R, dR, D)), 0.1 + 1e-12);
    }
}

// Hard case: the recipe for T and B jumps at n.z = 0; carried directions are continuous.
TEST(AxisFrame, CarriedDirectionsDoNotJumpWhereTheFrameDoes) {
    const glm::dvec3 dR(0, 0.2, 0.1), D = glm::normalize(glm::dvec3(0.3, 0.5, 0.8));
    const glm::dvec3 above = glm::normalize(glm::dvec3(0.8, 0.6, 1e-9));
    const glm::dvec3 below = glm::normalize(glm::dvec3(0.8, 0.6, -1e-9));
    EXPECT_GT(glm::length(frame_around(above)[0] - frame_around(below)[0]), 0.5);
    EXPECT_LT(glm::length(carry_with_axis(above, dR, D) - carry_with_axis(below, dR, D)), 1e-8);
}

}  // namespace

}  // namespace opaline::bake
