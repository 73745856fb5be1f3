#pragma once

#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Looks at meshes, colours and coefficients; traces nothing. Bodies should face outward
/// (orient_bodies). Work is bounded: where a huge mesh would need more, the answers are the
/// cautious ones.
///
/// Convexity is tested against the definition, with no assumption of how the mesh hangs together:
/// a part is convex if every other point of it lies below the plane through each of its points
/// across its normal there. A part with an edge that folds inward need not be looked at.
SceneFacts inspect_scene(const formats::Scene& scene);

}  // namespace opaline::bake
