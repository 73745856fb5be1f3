#include "bake/path_differentials/disk_map.h"

#include "tests/bake/path_differentials/event_check.h"

namespace opaline::bake {
namespace {

glm::dvec3 on_disk(const DiskPoint& at, const DiskColumn& by) {
    const glm::dvec2 across(-at.outward.y, at.outward.x);
    return {by.radial * at.outward + by.tangential * across, 0};
}

TEST(DiskMap, ColumnsAreDerivativesAndSpanTheAreaOfTheDisk) {
    tests::RandomInputs random(13);
    tests::ColumnErrors errors;
    tests::AreaErrors areas;
    for (int i = 0; i < tests::kRandomCases; ++i) {
        const double u = random.uniform(), v = random.uniform(0.01, 1);
        if (tests::is_near_diagonal(u, v)) continue;
        const DiskPoint at = map_to_disk(u, v);
        const auto point = [&](auto du, auto dv) {
            using S = decltype(du + dv);
            const auto xy = tests::concentric_point<S>(S(u) + du, S(v) + dv);
            return tests::Vector<S>{xy[0], xy[1], S(0)};
        };
        errors.add([&](auto d) { return point(d, decltype(d)(0)); }, on_disk(at, at.du));
        errors.add([&](auto d) { return point(decltype(d)(0), d); }, on_disk(at, at.dv));
        areas.add(on_disk(at, at.du), on_disk(at, at.dv), 1 / std::numbers::pi);
        EXPECT_NEAR(at.du.dq, 2 * at.radius * at.du.radial, 1e-15 * 8);
        EXPECT_NEAR(at.dv.dq, 2 * at.radius * at.dv.radial, 1e-15 * 8);
    }
    tests::expect_derivatives(errors);
    EXPECT_LT(areas.largest, 1e-12);
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
