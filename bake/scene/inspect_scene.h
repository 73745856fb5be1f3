#pragma once

#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Inspects meshes, colours and coefficients; traces no rays. Bodies should face outward
/// (orient_bodies). Work is bounded: for a huge mesh the answers are conservative.
///
/// Convexity is tested by its definition, without assumptions on connectivity: a part is convex if,
/// for each of its points, all its other points lie below the tangent plane there. A part with an
/// edge that folds inward is rejected at once.
SceneFacts inspect_scene(const formats::Scene& scene);

}  // namespace opaline::bake
