#pragma once

#include "formats/scene.h"
#include "tests/properties/things.h"

namespace opaline::tests {

/// A thing's surface in the cube [-1, 1]^3, of few triangles.
formats::Primitive make_mesh(Shape shape);

/// The same with a flaw as files have them. All but `flap`, `open` and `inside_out` leave the
/// surface where it is.
formats::Primitive with_flaw(formats::Primitive mesh, Flaw flaw);

}  // namespace opaline::tests
