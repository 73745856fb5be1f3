#pragma once

#include <cstdint>
#include <vector>

#include "bake/reference/reference_receivers.h"

namespace opaline::bake {

/// `wanted` vertices of the scene, seen along their normals, of thin-walled surfaces every
/// other one from behind, without those where bake and reference
/// model different geometry: inside bodies, on sharp edges, less than three mean free paths above
/// another surface inside their own body, on folds thinner than a mean free path that lie on their
/// own body, or with triangles that turn more than 60 degrees from their normal.
std::vector<ReferenceReceiver> choose_model_receivers(const ReferenceScene& scene,
                                                      std::uint32_t wanted, std::uint64_t seed);

}  // namespace opaline::bake
