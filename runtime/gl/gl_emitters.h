#pragma once

#include <vector>

#include "formats/opal/rgb.h"
#include "runtime/emitter_light.h"
#include "runtime/gl/gl_asset.h"

namespace opaline::runtime {

/// What the surface of each primitive sends out by itself, without its image; empty where there are
/// no emitters.
std::vector<formats::Rgb> own_radiances(const GlAsset& asset, const EmitterLight& light);

}  // namespace opaline::runtime
