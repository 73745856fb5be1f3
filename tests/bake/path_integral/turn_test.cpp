#include "bake/physics/path_integral/turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/bake/path_integral/path_support.h"

namespace opaline::bake {
namespace {

using glm::dvec3;

using std::numbers::pi;

Turn only_turn(dvec3 from, dvec3 to) {
    const Turns turns(from, to);
    EXPECT_EQ(turns.size(), 1u);
    return turns[0];
}

dvec3 in_plane(double angle) {
    return {std::sin(angle), 0, std::cos(angle)};
}

TEST(Turn, ArcsInAHomogeneousMediumEndAsTheTableSays) {
    for (const bool lateral : {false, true}) {
        OPALINE_VOLUME_ROWS(rows, lateral ? "arc_lateral" : "arc_along_v");
        for (const auto& row : rows) {
            const double angle = row.number("arg") * pi / 180;
            const Turn turn{{0, 0, 1}, {1, 0, 0}, in_plane(angle), angle};
            const dvec3 end = tests::arc_end(turn, row.number("size"), row.number("sigma_t"));
            // The table has 12 digits.
            EXPECT_NEAR(lateral ? end.x : end.z, row.value(),
                        1e-12 * std::max(1.0, 5 * row.value()))
                << row.id();
        }
    }
}

TEST(Turn, EndsInTheLastDirection) {
    const dvec3 from = glm::normalize(dvec3(0.3, -0.5, 0.2));
    const dvec3 side = glm::normalize(glm::cross(from, dvec3(1, 0, 0)));
    for (const double angle : {1e-13, 1e-9, 1e-4, 1.0, 2.0, pi - 1e-4, pi - 1e-9, pi}) {
        const dvec3 to = std::cos(angle) * from + std::sin(angle) * side;
        for (const Turn& turn : Turns(from, to)) {
            const dvec3 end = std::cos(turn.angle) * turn.from + std::sin(turn.angle) * turn.aside;
            EXPECT_LT(glm::length(end - to), 2e-12) << angle;
            EXPECT_NEAR(glm::length(turn.aside), 1, 1e-15) << angle;
            EXPECT_NEAR(glm::dot(turn.aside, from), 0, 1e-15) << angle;
        }
    }
}

TEST(Turn, BetweenEqualDirectionsIsNone) {
    const dvec3 v = glm::normalize(dvec3(1, 2, 3));
    const Turn turn = only_turn(v, v);
    EXPECT_EQ(turn.angle, 0);
    EXPECT_LT(glm::length(tests::arc_end(turn, 2, 4) - 0.5 * v), 1e-15);
}

TEST(Turn, BetweenOppositeDirectionsStandsForAllPlanes) {
    for (const dvec3 v : {dvec3(0, 0, 1), dvec3(0, 0, -1), glm::normalize(dvec3(1, -2, 0.1))}) {
        const Turns turns(v, -v);
        ASSERT_EQ(turns.size(), 4u);
        glm::dmat3 sum(0);
        dvec3 mean(0);
        for (const Turn& turn : turns) {
            EXPECT_EQ(turn.angle, pi);
            mean += turn.aside;
            sum += glm::outerProduct(turn.aside, turn.aside);
        }
        EXPECT_LT(glm::length(mean), 1e-15);
        for (int i = 0; i < 3; ++i) {
            const dvec3 even = 2.0 * (dvec3(i == 0, i == 1, i == 2) - v[i] * v);
            EXPECT_LT(glm::length(sum[i] - even), 1e-14);
        }
    }
}

}  // namespace
}  // namespace opaline::bake
