#pragma once

#include "formats/opal/asset.h"
#include "formats/scene.h"

namespace opaline::cli {

/// The scene's surfaces and volumes as far as a camera is placed by them (make_camera): positions
/// and triangles of surfaces, corners of volumes, in the world [m].
formats::Asset make_stand_in(const formats::Scene& scene);

}  // namespace opaline::cli
