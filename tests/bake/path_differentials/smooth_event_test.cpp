#include "bake/path_differentials/smooth_event.h"

#include <numbers>

#include "bake/path_differentials/bounded_change.h"
#include "tests/bake/path_differentials/event_check.h"

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
    tests::ColumnErrors errors;
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
        along = std::max(along, std::abs(glm::dot(event->refracted, dT)) / (1 + glm::length(dT)));
    }
    EXPECT_GT(refracted, tests::kRandomCases / 2);
    tests::expect_derivatives(errors, 1e-11);
    EXPECT_LT(along, 1e-12);
}

TEST(SmoothEvent, TotalReflectionIsNoRefraction) {
    const double beyond = std::asin(1 / 1.5) + 1e-6;
    EXPECT_FALSE(
        make_refraction({std::sin(beyond), 0, -std::cos(beyond)}, {0, 0, 1}, 1.5).has_value());
}

TEST(SmoothEvent, TransfersToPlanesAndSpheresAreDerivatives) {
    tests::RandomInputs random(5);
    tests::ColumnErrors spheres, planes;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 center = random.vector(), N = random.unit();
        const double radius = random.uniform(0.5, 2), t = random.uniform(0.5, 3);
        const glm::dvec3 on_sphere = center + radius * N;
        const glm::dvec3 D = -random.unit_facing(N, 0.2), P = on_sphere - t * D;
        const glm::dvec3 dP = random.vector(0.2), dD = random.change_of(D, 0.5);
        const glm::dvec3 change = bounded_transfer(D, N, t, dP, dD);
        const auto end = [&](auto x, auto distance) {
            return moved(P, dP, x) + distance(moved(P, dP, x), moved(D, dD, x)) * moved(D, dD, x);
        };
        spheres.add(
            [&](auto x) {
                using S = decltype(x);
                return end(x, [&](tests::Vector<S> from, tests::Vector<S> along) {
                    return tests::sphere_distance<S>(from, along, center, radius);
                });
            },
            change);
        planes.add(
            [&](auto x) {
                using S = decltype(x);
                return end(x, [&](tests::Vector<S> from, tests::Vector<S> along) {
                    return tests::plane_distance<S>(from, along, N, on_sphere);
                });
            },
            change);
    }
    tests::expect_derivatives(spheres, 1e-11);
    tests::expect_derivatives(planes, 1e-11);
}

// A ray that meets a convex mirror head-on spreads by d + s (1 + 2 d / r) per radian.
TEST(SmoothEvent, ConvexMirrorSpreadsByTheClosedForm) {
    const double r = 1.5, d = 3, s = 2;
    const glm::dvec3 D(0, 0, -1), N(0, 0, 1), dD(1, 0, 0);
    const glm::dvec3 on_mirror = bounded_transfer(D, N, d, glm::dvec3(0), dD);
    const Mirror event = make_mirror(D, N);
    const glm::dvec3 dR = event.change(dD, on_mirror / r);
    const glm::dvec3 spread = bounded_transfer(event.reflected, N, s, on_mirror, dR);
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
        glm::dvec3 dP = bounded_transfer(D, N, d1 / c_i, glm::dvec3(0), dD);
        const auto in = make_refraction(D, N, 1 / n);
        const glm::dvec3 inside = in->change(dD, glm::dvec3(0));
        dP = bounded_transfer(in->refracted, N, h / c_t, dP, inside);
        const auto out = make_refraction(in->refracted, N, n);
        const glm::dvec3 outside = out->change(inside, glm::dvec3(0));
        EXPECT_LT(glm::length(outside - dD), 4e-16 * 4);
        return bounded_transfer(out->refracted, N, d2 / c_i, dP, outside);
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
