#pragma once

#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/emitter_light.h"
#include "runtime/gl/gl_asset.h"

namespace opaline::runtime {

/// Adds the light of emitters to what dispatch_dots left in asset.radiance and asset.product: read
/// back, added up on the CPU as shade.h does, and written again. Once for each light.
void add_gl_emitters(const GlAsset& asset, const EmitterLight& light);

/// What the surface of each primitive sends out by itself, without its image; empty where there are
/// no emitters.
std::vector<formats::Rgb> own_radiances(const GlAsset& asset, const EmitterLight& light);

}  // namespace opaline::runtime
