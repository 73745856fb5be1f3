#pragma once

#include "bake/cli/view/view_state.h"

namespace opaline::cli {

/// A place on the picture: x to the right, y up, 0 in its middle; the shorter side spans [-1, 1].
struct BallPoint {
    double x = 0, y = 0;
};

/// Where a pixel lies so, from the top left corner.
BallPoint ball_point(double column, double row, double width, double height);

/// The eye around the target, with a level horizon: to the right and up, in degrees. The elevation
/// stays within 89.9 degrees of the horizon.
Viewpoint orbit_level(const Viewpoint& from, double azimuth, double elevation);

/// Arcball: the scene turns about the target so that what lies at `begin` on a ball comes to `end`.
/// Within sqrt(1/2) of the middle the ball is the unit sphere, outside a hyperbola z = 1 / (2 r),
/// which continues it smoothly (G. Bell; K. Shoemake, "ARCBALL", Graphics Interface 1992). The
/// horizon does not stay level.
Viewpoint turn_ball(const Viewpoint& from, BallPoint begin, BallPoint end);

/// Moves eye and target alike, so that what lies in the plane of the target moves by these shares
/// of the picture's height, to the right and up.
Viewpoint pan(const Viewpoint& from, float fov, double right, double up);

/// The eye's distance to the target times `factor`, which is above 0. Not below 1e-5 of the
/// target's distance from the origin.
Viewpoint zoom(const Viewpoint& from, double factor);

/// The same eye and target with +Y up.
Viewpoint level(const Viewpoint& from);

}  // namespace opaline::cli
