#include "bake/path_differentials/surface_shape.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

using tests::Vector;

TriangleAttributes random_attributes(tests::RandomInputs& random) {
    const glm::dvec3 around = random.unit();
    const auto normal = [&] { return random.unit_facing(around, 0.5); };
    const auto uv = [&] { return glm::dvec2(random.uniform(), random.uniform()); };
    return {{normal(), normal(), normal()}, {uv(), uv(), uv()}};
}

TEST(SurfaceShape, InterpolatedNormalsAndCoordinatesAreDerivatives) {
    tests::RandomInputs random(9);
    tests::ColumnErrors normals, coordinates;
    double along = 0, sums = 0;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const auto corners = random.triangle();
        const TriangleAttributes attributes = random_attributes(random);
        const glm::dvec3 e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
        double b = random.uniform(), c = random.uniform();
        if (b + c > 1) {
            b = 1 - b;
            c = 1 - c;
        }
        const double db = random.uniform(-1, 1), dc = random.uniform(-1, 1);
        const glm::dvec3 dP = db * e1 + dc * e2;
        const TriangleGradients at = triangle_gradients(corners, corners[0] + b * e1 + c * e2);
        const SurfaceShape shape = interpolated_shape(at, attributes);
        const auto mix = [&](auto x, auto corner_value) {
            using S = decltype(x);
            const S at_b = S(b) + x * S(db), at_c = S(c) + x * S(dc);
            return (S(1) - at_b - at_c) * Vector<S>(corner_value(0)) +
                   at_b * Vector<S>(corner_value(1)) + at_c * Vector<S>(corner_value(2));
        };
        const auto normal = [&](std::size_t k) { return attributes.normal[k]; };
        const auto uv = [&](std::size_t k) { return glm::dvec3(attributes.uv[k], 0); };
        normals.add([&](auto x) { return tests::normalized(mix(x, normal)); }, shape.dN_dP * dP);
        coordinates.add([&](auto x) { return mix(x, uv); }, glm::dvec3(shape.duv_dP * dP, 0));
        along = std::max(along, std::abs(glm::dot(shape.N, shape.dN_dP * dP)));
        sums = std::max(sums, std::abs(at.bary.x + at.bary.y + at.bary.z - 1));
    }
    tests::expect_derivatives(normals, 1e-10);
    tests::expect_derivatives(coordinates, 1e-10);
    EXPECT_LT(along, 1e-12);
    EXPECT_LT(sums, 1e-14);
}

TEST(SurfaceShape, SphereTurnsItsNormalWithThePoint) {
    const glm::dvec3 center(1, 2, 3), N = glm::normalize(glm::dvec3(1, -2, 0.5));
    const SurfaceShape sphere = sphere_shape(center, 2, center + 2.0 * N);
    const glm::dvec3 dP = glm::cross(sphere.N, glm::dvec3(0.2, 0.1, 0.4));
    EXPECT_LT(glm::length(sphere.dN_dP * dP - dP / 2.0), 1e-15);
    EXPECT_LT(glm::length(sphere.N - N), 1e-15);
    const SurfaceShape inside = flipped(sphere);
    EXPECT_EQ(inside.N, -sphere.N);
    EXPECT_EQ(inside.dN_dP * dP, -(sphere.dN_dP * dP));
}

TEST(SurfaceShape, TriangleWithoutAreaIsFlatAndOnePointOfTheTexture) {
    const glm::dvec3 A(1, 2, 3), along(1e-3, 2e-3, -1e-3);
    for (const glm::dvec3& C : {A, A + along, A + 3.0 * along}) {
        const TriangleGradients at = triangle_gradients({A, A + along, C}, A);
        const SurfaceShape shape = interpolated_shape(
            at, {{glm::dvec3(0, 0, 1), {0, 0.6, 0.8}, {0.6, 0, 0.8}}, {{{0, 0}, {1, 0}, {0, 1}}}});
        EXPECT_EQ(shape.dN_dP * along, glm::dvec3(0));
        EXPECT_EQ(shape.duv_dP * along, glm::dvec2(0));
        EXPECT_NEAR(glm::length(shape.N), 1, 1e-15);
    }
    // A needle of a millionth of its length has both.
    const TriangleGradients thin =
        triangle_gradients({A, A + glm::dvec3(1, 0, 0), A + glm::dvec3(0, 1e-6, 0)}, A);
    EXPECT_NEAR(thin.gradient[2].y, 1e6, 1);
}

}  // namespace
}  // namespace opaline::bake
