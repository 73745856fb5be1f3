#pragma once

#include "formats/opal/normal_maps.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The normal maps of a scene's surfaces, for pictures: rows know nothing of them. Images have the
/// scene's numbers. Primitives in scene order; maps of scale 0 are left out.
formats::NormalMaps pack_normal_maps(const formats::Scene& scene);

}  // namespace opaline::bake
