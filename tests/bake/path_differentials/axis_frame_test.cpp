#include "bake/physics/path_differentials/axis_frame.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

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
