#pragma once

#include <cstdint>
#include <vector>

#include "formats/gltf/document.h"
#include "formats/gltf/resources.h"

namespace opaline::formats::gltf {

/// Elements of an accessor that validate_document found sound, sparse values applied. Where a
/// sparse index is out of range, `sparse_index_bad` is set and that value left out.
template <class T>
struct AccessorValues {
    std::vector<T> value;  ///< count * components, element after element
    bool sparse_index_bad = false;
};

/// As real numbers. Integers marked `normalized` map to [0,1] or [-1,1] by the equations of the
/// specification ("Animations", also used by KHR_mesh_quantization); others keep their value.
AccessorValues<float> read_floats(const Document& document, const std::vector<Bytes>& buffers,
                                  std::uint32_t accessor);

/// As whole numbers. Precondition: an unsigned component type.
AccessorValues<std::uint32_t> read_indices(const Document& document,
                                           const std::vector<Bytes>& buffers,
                                           std::uint32_t accessor);

}  // namespace opaline::formats::gltf
