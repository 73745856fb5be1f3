#include "bake/physics/path_differentials/surface_shape.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

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

}  // namespace
}  // namespace opaline::bake
