#pragma once

#include "bake/example/field.h"

namespace opaline::bake {

/// A solid and a box that its surface keeps clear of, in millimetres, standing on y = 0.
struct Solid {
    Field field;
    Box bounds;
};

/// A resting swan with lifted wings on a pebble of rippled water: one closed form without holes or
/// handles, about 120 mm tall, facing +Z. Body 45 mm thick; wing and tail feathers 2 to 4 mm, thin
/// enough for light to come through in marble, jade or wax.
Solid make_swan();

}  // namespace opaline::bake
