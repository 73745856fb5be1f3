#pragma once

#include "bake/scene/scene_facts.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Inspects meshes, colours and coefficients; traces no rays. Bodies should face outward
/// (orient_bodies). Work is bounded: for a huge mesh the answers are conservative.
///
/// Where some receiver sees a corner of its own triangle or an end of the scene above its horizon,
/// nothing more is asked about occlusion. Else the whole scene is searched, unless an edge folds
/// inward. Topology is that of parts whose boxes are apart; copies of one mesh are inspected once:
/// a scene of instances costs a pass over its vertices and triangles.
///
/// `slots`: become SceneFacts::slots.
SceneFacts inspect_scene(const formats::Scene& scene, formats::Slots slots = {});

}  // namespace opaline::bake
