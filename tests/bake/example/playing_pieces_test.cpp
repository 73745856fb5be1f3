// Parts of the example `playing-pieces`.
#include "bake/lab/example/scene_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/lab/example/example_scenes.h"
#include "tests/bake/example/facing.h"

namespace opaline::bake {
namespace {

TEST(PlayingPieces, SurfacesFaceOutward) {
    expect_facing_normals(make_board());
    for (const TriangleMesh& piece :
         {make_pawn(0, 0), make_draughtsman(0, 0), make_squashed_ball(0, 0), make_stand(0, 0)}) {
        EXPECT_GT(enclosed_volume(piece), 1000);
        expect_facing_normals(piece);
    }
}

TEST(PlayingPieces, StandInSquaresOfTheirOwn) {
    const auto objects = make_example("playing-pieces");
    ASSERT_TRUE(objects);
    std::vector<std::pair<double, double>> squares;
    for (const GltfObject& object : *objects) {
        if (object.name == "Board" || object.name == "Floor") continue;
        glm::dvec3 low(1), high(-1);
        for (const glm::dvec3& p : object.mesh.position) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        if (object.name == "Glass") {  // on its stand
            EXPECT_GT(low.y, 0.017);
            continue;
        }
        EXPECT_NEAR(low.y, -0.0004, 1e-9) << object.name;
        constexpr double kSquare = 1e-3 * kSquareSide;
        const std::pair square{std::floor(low.x / kSquare), std::floor(low.z / kSquare)};
        EXPECT_LT(high.x, (square.first + 1) * kSquare + 1e-3) << object.name;
        EXPECT_LT(high.z, (square.second + 1) * kSquare + 1e-3) << object.name;
        EXPECT_LE(std::abs(square.first + 0.5), 4);
        EXPECT_LE(std::abs(square.second + 0.5), 4);
        EXPECT_EQ(std::ranges::count(squares, square), 0);
        squares.push_back(square);
    }
    EXPECT_EQ(squares.size(), 7u);
}

}  // namespace
}  // namespace opaline::bake
