#include "bake/physics/path_differentials/lobe.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

glm::dvec3 on_disk(const DiskPoint& at, const DiskColumn& by) {
    const glm::dvec2 across(-at.outward.y, at.outward.x);
    return {by.radial * at.outward + by.tangential * across, 0};
}

// Hard case: 0/0 in the middle.
TEST(DiskMap, MiddleHasTheColumns2AndHalfPi) {
    const DiskPoint at = map_to_disk(0.5, 0.5);
    EXPECT_EQ(on_disk(at, at.du), glm::dvec3(2, 0, 0));
    EXPECT_NEAR(on_disk(at, at.dv).y, std::numbers::pi / 2, 1e-16);
    EXPECT_EQ(on_disk(at, at.dv).x, 0);
}

// Hard case: columns jump where |a| = |b|, what they span does not.
TEST(DiskMap, AreaIsContinuousAcrossTheDiagonals) {
    for (const double sign : {1.0, -1.0}) {
        for (const double off : {-1e-9, 0.0, 1e-9}) {
            const DiskPoint at = map_to_disk(0.8 + off, 0.5 + sign * 0.3);
            const glm::dvec3 area = glm::cross(on_disk(at, at.du), on_disk(at, at.dv));
            EXPECT_NEAR(area.z, std::numbers::pi, 1e-12);
        }
    }
}

}  // namespace
}  // namespace opaline::bake
