#pragma once

#include <vector>

#include "formats/opal/holes.h"
#include "formats/opal/preview_image.h"
#include "formats/scene.h"

namespace opaline::bake {

/// The holes of a scene's surfaces, as pictures need them (has_holes). Adds the alpha of their
/// images, one each, to `images`. Primitives in scene order.
formats::Holes pack_holes(const formats::Scene& scene,
                          std::vector<formats::PreviewImageData>& images);

}  // namespace opaline::bake
