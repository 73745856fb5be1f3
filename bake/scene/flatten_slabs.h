#pragma once

#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// Media that fill sheets (Medium::thickness > 0) become thin-walled surfaces: shares of the light
/// that enters a slab of the medium and leaves it scattered, on either side, under even
/// light (share_even_light). What a boundary of index above 1 mirrors becomes gloss, of one below 1
/// diffuse reflection.  Warns where much light passes a sheet unscattered, which is not simulated.
std::vector<formats::Diagnostic> flatten_slabs(formats::Scene& scene);

}  // namespace opaline::bake
