#pragma once

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Whether most of a lamp's power starts inside of media that scatter: of the rays from where it
/// starts, in all directions, most meet the back of such a medium's surface first. Such light goes
/// nowhere in a bake.
bool is_immersed(const formats::Scene& scene, const RayScene& rays, const LampSources& lamp);

}  // namespace opaline::bake
