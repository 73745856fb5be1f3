#include "bake/path_differentials/area_sample.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::Vector;

TEST(AreaSample, TrianglesAreDerivativesAndSpanTheirArea) {
    tests::RandomInputs random(19);
    for (const bool folded : {true, false}) {
        tests::ColumnErrors errors;
        tests::AreaErrors areas;
        for (int i = 0; i < tests::kRandomCases; ++i) {
            const auto corners = random.triangle();
            const double u = random.uniform(0.02, 1), v = random.uniform();
            if (folded && std::abs(u - v) < 1e-5) {
                continue;  // the fold
            }
            const AreaSample at = folded ? sample_triangle_folded(corners, u, v)
                                         : sample_triangle_sqrt(corners, u, v);
            const auto point = [&](auto du, auto dv) {
                using S = decltype(du + dv);
                return tests::triangle_point<S>(
                    {Vector<S>(corners[0]), Vector<S>(corners[1]), Vector<S>(corners[2])},
                    S(u) + du, S(v) + dv, folded);
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
}

TEST(AreaSample, ParallelogramsHaveTheirEdgesAsColumns) {
    tests::RandomInputs random(20);
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const glm::dvec3 e1 = random.vector(), e2 = random.vector();
        const double u = random.uniform(), v = random.uniform();
        const AreaSample at = sample_parallelogram({1, 2, 3}, e1, e2, u, v);
        EXPECT_EQ(at.dP_du, e1);
        EXPECT_EQ(at.dP_dv, e2);
        EXPECT_EQ(at.P, glm::dvec3(1, 2, 3) + u * e1 + v * e2);
    }
}

}  // namespace
}  // namespace opaline::bake
