#include "bake/physics/path_differentials/lobe.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

/// D(m) G1(w) (w.m) / w.z of [Walter2007] over solid angle of m [1/sr].
double seen_density(const glm::dvec3& m, const glm::dvec3& w, const MicrofacetWidths& a) {
    const glm::dvec3 scaled(m.x / a.x, m.y / a.y, m.z), stretched(a.x * w.x, a.y * w.y, w.z);
    const double square = glm::dot(scaled, scaled);
    return 2 * glm::dot(w, m) /
           (std::numbers::pi * a.x * a.y * square * square * (w.z + glm::length(stretched)));
}

// Head-on the cap is the whole upper half of the sphere, and its middle has a limit.
TEST(VisibleNormal, HeadOnInTheMiddleIsTheSurfacesNormal) {
    const VisibleNormal at = sample_visible_normal({0, 0, 1}, {0.3, 0.3}, 0.5, 0.5);
    EXPECT_LT(glm::length(at.m - glm::dvec3(0, 0, 1)), 1e-15);
    const double product =
        glm::length(glm::cross(at.dm_du, at.dm_dv)) * seen_density(at.m, {0, 0, 1}, {0.3, 0.3});
    EXPECT_NEAR(product, 1, 1e-12);
    // Tilting the view by x tilts the stretched one by 0.3 x, its half by 0.15 x, m by 0.3 of that.
    EXPECT_LT(glm::length(at.dm_dwi * glm::dvec3(1, 0, 0) - glm::dvec3(0.045, 0, 0)), 1e-15);
}

}  // namespace
}  // namespace opaline::bake
