#include "bake/path_differentials/surface_shape.h"

#include "bake/path_differentials/area_sample.h"
#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::Vector;

TEST(SurfaceShape, InterpolatedNormalsAreDerivatives) {
    tests::RandomInputs random(9);
    tests::ColumnErrors errors;
    double along = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const auto corners = random.triangle();
        const glm::dvec3 around = random.unit();
        const auto facing = [&] { return random.unit_facing(around, 0.5); };
        const std::array<glm::dvec3, 3> normals{facing(), facing(), facing()};
        const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
        const double b = random.uniform(), c = random.uniform(0, 1 - b);
        const double db = random.uniform(-1, 1), dc = random.uniform(-1, 1);
        const glm::dvec3 dP = db * e1 + dc * e2;
        const SurfaceShape shape =
            interpolated_shape(corners, normals, corners[0] + b * e1 + c * e2);
        errors.add(
            [&](auto x) {
                using S = decltype(x);
                const S at_b = S(b) + x * S(db), at_c = S(c) + x * S(dc);
                return tests::normalized((S(1) - at_b - at_c) * Vector<S>(normals[0]) +
                                         at_b * Vector<S>(normals[1]) +
                                         at_c * Vector<S>(normals[2]));
            },
            shape.dN_dP * dP);
        along = std::max(along, std::abs(glm::dot(shape.N, shape.dN_dP * dP)));
    }
    tests::expect_derivatives(errors, 1e-10);
    EXPECT_LT(along, 1e-12);
}

TEST(SurfaceShape, TriangleWithoutAreaIsFlat) {
    const glm::dvec3 A(1, 2, 3), along(1e-3, 2e-3, -1e-3);
    const std::array<glm::dvec3, 3> normals{glm::dvec3(0, 0, 1), {0, 0.6, 0.8}, {0.6, 0, 0.8}};
    for (const glm::dvec3& C : {A, A + along, A + 3.0 * along}) {
        const SurfaceShape shape = interpolated_shape({A, A + along, C}, normals, A);
        EXPECT_EQ(shape.dN_dP * along, glm::dvec3(0));
        EXPECT_NEAR(glm::length(shape.N), 1, 1e-15);
    }
    // A needle of a millionth of its length is not.
    const SurfaceShape thin =
        interpolated_shape({A, A + glm::dvec3(1, 0, 0), A + glm::dvec3(0, 1e-6, 0)}, normals, A);
    EXPECT_NEAR(glm::length(thin.dN_dP * glm::dvec3(0, 1e-6, 0)), 0.6, 1e-6);
}

TEST(AreaSample, FoldedTrianglesAreDerivativesAndSpanTheirArea) {
    tests::RandomInputs random(19);
    tests::ColumnErrors errors;
    tests::AreaErrors areas;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const auto corners = random.triangle();
        const double u = random.uniform(), v = random.uniform();
        if (std::abs(u - v) < 1e-5) {
            continue;  // the fold
        }
        const AreaSample at = sample_triangle_folded(corners, u, v);
        const auto point = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            return tests::triangle_point<S>(
                {Vector<S>(corners[0]), Vector<S>(corners[1]), Vector<S>(corners[2])}, S(u) + du,
                S(v) + dv);
        };
        errors.add([&](auto d) { return point(d, 0 * d); }, at.dP_du);
        errors.add([&](auto d) { return point(0 * d, d); }, at.dP_dv);
        EXPECT_LT(glm::length(at.P - values(point(0.0, 0.0))), 1e-14);
        const double area =
            glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) / 2;
        areas.add(at.dP_du, at.dP_dv, 1 / area);
    }
    tests::expect_derivatives(errors);
    EXPECT_LT(areas.largest, 1e-12);
}

}  // namespace
}  // namespace opaline::bake
