#include "bake/path_differentials/smooth_event.h"

#include <numbers>

#include "tests/bake/path_differentials/event_check.h"
#include "tests/bake/path_differentials/transfer.h"

namespace opaline::bake {
namespace {

using tests::moved;

TEST(SmoothEvent, MirrorsAreDerivativesAndStayUnit) {
    tests::RandomInputs random(7);
    tests::ColumnErrors errors;
    double along = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 N = random.unit(), D = -random.unit_facing(N, 0.02);
        const glm::dvec3 dD = random.change_of(D), dN = random.change_of(N);
        const Mirror event = make_mirror(D, N);
        const glm::dvec3 dR = event.change(dD, dN);
        errors.add([&](auto x) { return tests::mirrored(moved(D, dD, x), moved(N, dN, x)); }, dR);
        along = std::max(along, std::abs(glm::dot(event.reflected, dR)));
    }
    tests::expect_derivatives(errors);
    EXPECT_LT(along, 1e-12);
}

TEST(SmoothEvent, RefractionsAreDerivativesAndStayUnit) {
    tests::RandomInputs random(8);
    tests::ColumnErrors errors, dispersion;
    double along = 0;
    int refracted = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 N = random.unit(), D = -random.unit_facing(N, 0.02);
        const glm::dvec3 dD = random.change_of(D), dN = random.change_of(N);
        const double eta = random.uniform(0.5, 1.8);
        const auto event = make_refraction(D, N, eta);
        if (!event || event->c_t < 0.1) {  // nearer to the critical angle: BoundedChange
            continue;
        }
        ++refracted;
        const glm::dvec3 dT = event->change(dD, dN);
        errors.add(
            [&](auto x) {
                using S = decltype(x);
                return tests::refracted<S>(moved(D, dD, x), moved(N, dN, x), S(eta));
            },
            dT);
        dispersion.add(
            [&](auto x) {
                using S = decltype(x);
                return tests::refracted<S>(D, N, S(eta) + x);
            },
            event->change_with_eta());
        along = std::max(along, std::abs(glm::dot(event->refracted, dT)) / (1 + glm::length(dT)));
    }
    EXPECT_GT(refracted, tests::kRandomCases / 2);
    tests::expect_derivatives(errors, 1e-11);
    tests::expect_derivatives(dispersion, 1e-10);
    EXPECT_LT(along, 1e-12);
}

// Snell's law, differentiated: d(theta_t) / d(theta_i) = eta cos_i / cos_t.
TEST(SmoothEvent, RefractionInThePlaneOfIncidenceIsSnells) {
    const double eta = 1 / 1.5, theta = 0.7;
    const glm::dvec3 D(std::sin(theta), 0, -std::cos(theta)), N(0, 0, 1);
    const auto event = make_refraction(D, N, eta);
    ASSERT_TRUE(event);
    const glm::dvec3 dT = event->change({std::cos(theta), 0, std::sin(theta)}, glm::dvec3(0));
    EXPECT_NEAR(glm::length(dT), eta * std::cos(theta) / event->c_t, 1e-14);
}

TEST(SmoothEvent, TotalReflectionIsNoRefraction) {
    const double beyond = std::asin(1 / 1.5) + 1e-6;
    EXPECT_FALSE(
        make_refraction({std::sin(beyond), 0, -std::cos(beyond)}, {0, 0, 1}, 1.5).has_value());
}

// What a flat mirror shows is what a camera behind it sees.
TEST(SmoothEvent, PlaneMirrorIsTheUnfoldedCamera) {
    const glm::dvec3 D = glm::normalize(glm::dvec3(0.3, -0.2, -1)), N(0, 0, 1);
    const glm::dvec3 dD = glm::dvec3(0.4, 0.1, 0) - D * glm::dot(D, glm::dvec3(0.4, 0.1, 0));
    const double first = 2 / -D.z, second = 3 / -D.z;
    const glm::dvec3 on_mirror = transfer_to_plane(D, N, first, glm::dvec3(0), dD).dP;
    const Mirror event = make_mirror(D, N);
    const glm::dvec3 folded =
        transfer_to_plane(event.reflected, N, second, on_mirror, event.change(dD, glm::dvec3(0)))
            .dP;
    const glm::dvec3 straight = transfer_to_plane(D, N, first + second, glm::dvec3(0), dD).dP;
    EXPECT_LT(glm::length(folded - straight), 1e-12 * glm::length(straight));
}

// A ray that meets a convex mirror head-on spreads by d + s (1 + 2 d / r) per radian.
TEST(SmoothEvent, ConvexMirrorSpreadsByTheClosedForm) {
    const double r = 1.5, d = 3, s = 2;
    const glm::dvec3 D(0, 0, -1), N(0, 0, 1), dD(1, 0, 0);
    const glm::dvec3 on_mirror = transfer_to_plane(D, N, d, glm::dvec3(0), dD).dP;
    const Mirror event = make_mirror(D, N);
    const glm::dvec3 dR = event.change(dD, on_mirror / r);
    const glm::dvec3 spread = transfer_to_plane(event.reflected, N, s, on_mirror, dR).dP;
    EXPECT_NEAR(spread.x, d + s * (1 + 2 * d / r), 1e-12);
    EXPECT_NEAR(spread.x, 13, 1e-12);
}

// A plate of glass, from 40 degrees: widths on a parallel plane in closed form, and the direction
// leaves as it came.
TEST(SmoothEvent, PlateOfGlassSpreadsByTheClosedForm) {
    const double n = 1.5, h = 0.7, d1 = 2, d2 = 1.3, theta = 40 * std::numbers::pi / 180;
    const double c_i = std::cos(theta), s_i = std::sin(theta), s_t = s_i / n;
    const double c_t = std::sqrt(1 - s_t * s_t);
    const glm::dvec3 D(s_i, 0, -c_i), N(0, 0, 1);
    const auto through = [&](const glm::dvec3& dD) {
        glm::dvec3 dP = transfer_to_plane(D, N, d1 / c_i, glm::dvec3(0), dD).dP;
        const auto in = make_refraction(D, N, 1 / n);
        const glm::dvec3 inside = in->change(dD, glm::dvec3(0));
        dP = transfer_to_plane(in->refracted, N, h / c_t, dP, inside).dP;
        const auto out = make_refraction(in->refracted, N, n);
        const glm::dvec3 outside = out->change(inside, glm::dvec3(0));
        EXPECT_LT(glm::length(outside - dD), 4e-16 * 4);
        return transfer_to_plane(out->refracted, N, d2 / c_i, dP, outside).dP;
    };
    // dD per radian of the polar angle, and per radian of the azimuth.
    const glm::dvec3 tangential = through({c_i, 0, s_i}), sagittal = through({0, s_i, 0});
    EXPECT_NEAR(tangential.x, (d1 + d2) / (c_i * c_i) + h * c_i / (n * c_t * c_t * c_t), 1e-12);
    EXPECT_NEAR(tangential.x, 6.10814656357358, 1e-12);
    EXPECT_NEAR(sagittal.y, (d1 + d2) * s_i / c_i + h * s_t / c_t, 1e-12);
    EXPECT_NEAR(sagittal.y, 3.10102394384661, 1e-12);
}

}  // namespace
}  // namespace opaline::bake
