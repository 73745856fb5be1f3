#pragma once

#include <cstdint>

#include "bake/exchange/lamps/lamp_sources.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The material of the medium, one that scatters, inside of which most of a lamp's power starts:
/// most rays from there, in all directions, meet the back of its surface first. formats::kNone:
/// there is none.
std::uint32_t medium_around(const formats::Scene& scene, const RayScene& rays,
                            const LampSources& lamp);

}  // namespace opaline::bake
