#pragma once

#include "bake/scene/orient_bodies.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::cli {

/// Whether paths can be traced through anything of the scene; warns of what they leave out. Errors:
/// bad_input (a cloud layer alone), and warnings that count as errors.
void check_traceable(const formats::Scene& scene);

/// The scene's bodies as a bake sees them, with warnings about faults of their meshes.
bake::OrientedBodies close_bodies(const formats::Scene& scene);

}  // namespace opaline::cli
