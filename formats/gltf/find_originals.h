#pragma once

#include <cstddef>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/walk_scene.h"

namespace opaline::formats::gltf {

/// Of each instance the first one of its mesh, weights and scene transform but for where it stands,
/// or itself: none is skinned, and an original is its own.
std::vector<std::size_t> find_originals(const Document& document,
                                        const std::vector<MeshInstance>& instances);

/// The instances that are their own originals.
std::vector<MeshInstance> originals_of(const Document& document,
                                       const std::vector<MeshInstance>& instances);

}  // namespace opaline::formats::gltf
