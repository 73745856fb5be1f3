#pragma once

#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// The receiver behind a point of a thin surface. `inside.inner` mirrors the origin in front of the
/// point's own triangles; where that was moved, as from inside a body, the origin behind moves
/// along.
inline Receiver other_side(const Receiver& front, const BodyPoint& inside) {
    const glm::vec3 moved = front.origin - (2.0f * inside.position - inside.inner);
    return {inside.inner + moved, -front.normal};
}

}  // namespace opaline::bake
