#pragma once

#include <cstdint>
#include <vector>

#include "bake/reference/reference_receivers.h"

namespace opaline::bake {

/// `wanted` of the scene's vertices, seen along their normals, without those at which the bake and
/// the reference do not mean the same: inside bodies, on sharp edges of one, or less than three
/// mean free paths above a surface that lies within their own body.
std::vector<ReferenceReceiver> choose_model_receivers(const ReferenceScene& scene,
                                                      std::uint32_t wanted, std::uint64_t seed);

}  // namespace opaline::bake
