#pragma once

#include "bake/example/write_gltf.h"
#include "formats/image/image.h"

namespace opaline::bake {

/// Parts of a chequered board with playing pieces. Lengths in millimetres.

inline constexpr double kSquareSide = 30;  ///< of one of the 8 x 8 squares
inline constexpr double kBoardSide = 272;  ///< with its border

/// A pawn on y = 0 at (x, z), turned about its axis, 41 mm tall.
TriangleMesh make_pawn(double x, double z);

/// A flat draughtsman with a rounded rim on y = 0, 8 mm tall.
TriangleMesh make_draughtsman(double x, double z);

/// A foot on y = 0 with a cup on top, and the squashed ball just above it: 13 mm across each way
/// from its axis, 9 mm up and down.
TriangleMesh make_stand(double x, double z);
TriangleMesh make_squashed_ball(double x, double z);

/// The board's upper side, y = 0, and its rim down to y = -12.
TriangleMesh make_board();

/// Its texture coordinates, one a vertex: the picture lies on the upper side, its border on the
/// rim.
std::vector<glm::dvec2> board_coordinates(const TriangleMesh& board);

/// Light and dark wood with grain along each square, within a border.
formats::Image8 paint_board();

}  // namespace opaline::bake
