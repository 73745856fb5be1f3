#pragma once

#include "bake/example/triangle_mesh.h"

namespace opaline::bake {

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

}  // namespace opaline::bake
