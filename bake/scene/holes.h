#pragma once

#include "bake/scene/body_shells.h"

namespace opaline::bake {

/// Bound on the area [m^2] of the holes of a surface: of discs with borders as long as theirs, hole
/// by hole. Open edges that are connected bound one hole. By the isoperimetric inequality pieces of
/// a plane have holes as large as themselves at least, however many they are.
double bound_hole_area(const BodyShells& body);

}  // namespace opaline::bake
