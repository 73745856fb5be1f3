#pragma once

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <string>
#include <vector>

#include "bake/lab/example/solid_mesh.h"
#include "bake/lab/example/triangle_mesh.h"
#include "bake/lab/example/write_gltf.h"
#include "formats/image/image.h"

namespace opaline::bake {

/// A smooth spine with a radius along it: a uniform cubic B-spline through its two end points. It
/// is twice differentiable, so a tube around it shows no rings.
class TaperedCurve {
  public:
    /// `control`: at least two points as (x, y, z, radius) [mm].
    explicit TaperedCurve(const std::vector<glm::dvec4>& control);

    struct Nearest {
        glm::dvec3 point;    ///< on the spine
        glm::dvec3 tangent;  ///< unit
        double radius;       ///< of the tube there
        double fraction;     ///< along the spine, 0 at its start, 1 at its end
    };
    /// The point of the spine nearest to `p`.
    Nearest nearest(const glm::dvec3& p) const;

    /// Signed distance to the tube, exact up to its taper.
    double distance(const glm::dvec3& p) const;

    /// A lower bound of the distance from `p` to the tube, cheap and tight for a nearly straight
    /// one.
    double distance_bound(const glm::dvec3& p) const;

  private:
    struct Point {
        glm::dvec4 value, first, second;
    };
    Point evaluate(double t) const;

    std::vector<std::array<glm::dvec4, 4>> spans_;  ///< polynomials, constant term first
    std::vector<glm::dvec3> samples_;  ///< even in the parameter: where the search begins
    double reach_ = 0.0;               ///< largest distance of a point of the tube from its chord
    double chord_distance(const glm::dvec3& p) const;
};

/// A ball from an icosahedron whose triangles are cut into four `levels` times:
/// 10 * 4^levels + 2 vertices.
TriangleMesh make_sphere(glm::dvec3 centre, double radius, unsigned levels);

/// A point of a profile: its distance from the axis, its height, and its normal in that plane, of
/// any length. An edge has a point for each of its two normals.
struct ProfilePoint {
    double radius = 0, height = 0;
    glm::dvec2 normal{1, 0};
};

/// The profile turned about +Y, with `around` cells; from below to above its outside is in front.
TriangleMesh turn_about_axis(std::span<const ProfilePoint> profile, unsigned around);

/// A square floor at y = 0, facing up.
struct FloorOptions {
    double finest = 1.8;        ///< cell under and around the object [mm]
    double fine_radius = 55.0;  ///< of the disc about the origin with that cell [mm]
    double growth = 0.1;        ///< cell size per distance beyond the disc, at most 0.15
    unsigned levels = 9;        ///< the floor is 2^levels finest cells wide
};

/// Squares that double in size away from the middle, as right-angled triangles of 45 degrees
/// without hanging corners: shadows stay sharp at the object's foot for few vertices.
TriangleMesh make_floor(const FloorOptions& options);

/// A trefoil, the torus knot (2, 3), as a tube that stands on two of its lobes and shows its three
/// to +Z. Lengths in millimetres.
struct KnotOptions {
    double height = 240.0;
    double sink = 0.4;     ///< depth of its lowest point below the floor
    unsigned along = 460;  ///< vertices along the tube, at least 3
    unsigned around = 56;  ///< vertices around it, at least 3
};

/// Closed and without twist: the rings turn evenly so that the last one meets the first.
TriangleMesh make_knot(const KnotOptions& options);

/// A rosette of arched leaves around a common foot at the origin, as surfaces without an inside:
/// upper side outward. Lengths in millimetres.
struct LeavesOptions {
    unsigned leaves = 11;
    unsigned along = 40, across = 16;  ///< cells of a leaf, each at least 2
};

TriangleMesh make_leaves(const LeavesOptions& options);

/// Parts of a table lamp that stands at the origin. Lengths in millimetres.

/// A shade without an inside, open below and above: a cone, outward side in front.
struct ShadeOptions {
    double low = 150, high = 270;               ///< heights of its rims
    double low_radius = 105, high_radius = 65;  ///< of its rims
    unsigned around = 48, along = 12;           ///< cells
};
TriangleMesh make_shade(const ShadeOptions& options);

/// The same with an inside, closed: it extends inward by `thickness` > 0, less than its radii, with
/// a flat rim above and below.
TriangleMesh make_thick_shade(const ShadeOptions& options, double thickness);

/// A foot and a stem below the shade, turned about +Y.
TriangleMesh make_lamp_foot();

/// An upright wall at z = -230 behind the lamp, facing +z.
TriangleMesh make_wall();

/// An upright rectangle that faces -x, its foot at (x, 0, z), width along z.
struct PanelOptions {
    double x = 260, z = -30;
    double width = 180, height = 200;
    unsigned cells = 8;
};
TriangleMesh make_panel(const PanelOptions& options);

/// What a first scene in a modeller is made of, on y = 0. Lengths in millimetres.

/// A monkey's head with ears, 0.46 m tall at the origin, its face toward +Z and a little to +X.
TriangleMesh make_monkey_head();

/// A ring that lies on the floor, without a seam: along x around vertices.
struct TorusOptions {
    double ring = 300, tube = 95;  ///< radii of the tube's centre line and of the tube
    unsigned along = 48, around = 16;
};
TriangleMesh make_torus(glm::dvec3 place, const TorusOptions& options);

/// A cube with a normal for each side: 24 vertices and 12 triangles. `turn`: about +Y [rad].
TriangleMesh make_cube(glm::dvec3 place, double side, double turn);

/// Smooth meshes whose relief is in a normal map. Lengths in millimetres.

/// A mesh with texture coordinates, one a vertex; v = 0 on top of the image.
struct MappedMesh {
    TriangleMesh mesh;
    std::vector<glm::dvec2> texcoord;
};

/// Parallelogram corner + s a + t b, s and t in [0, 1], cut into cells x cells squares; its front
/// has the normal of cross(a, b). The image repeats every `tile` along both, upright along b.
MappedMesh make_panel(glm::dvec3 corner, glm::dvec3 a, glm::dvec3 b, unsigned cells, double tile);

/// A ball by longitude and latitude; the image goes around it four times and from pole to pole
/// twice.
MappedMesh make_mapped_ball(glm::dvec3 centre, double radius);

/// Normals of four courses of bricks, two by four to a tile, rough on their faces: red toward
/// growing u, green upward, code 128 is 0. The image repeats.
formats::Image8 paint_brick_normals();

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

/// The sea with sheets of pack ice, that break into floes at their edges, on a square of 24 km seen
/// from above: sRGB codes of the albedo. Repeats without a seam.
formats::Image8 make_icy_sea();

/// A media file (formats/media/README.md) of a layer of stratocumulus with gaps, 800 m above the
/// ground of the picture `ground`: both go on to the horizon.
std::string describe_stratus(const std::string& ground);

/// A solid and a box that its surface keeps clear of, in millimetres, standing on y = 0.
struct Solid {
    ScalarField field;
    Box bounds;
};

/// A resting swan with lifted wings on a pebble of rippled water: one closed form without holes or
/// handles, about 120 mm tall, facing +Z. Body 45 mm thick; wing and tail feathers 2 to 4 mm, thin
/// enough for light to come through in marble, jade or wax.
Solid make_swan();

}  // namespace opaline::bake
