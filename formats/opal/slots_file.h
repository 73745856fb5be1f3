#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// Vertices that share rows, as they stand in a file: `SHAR`, and what is stored of slots instead
/// of vertices, so that an unwelded mesh takes hardly more bytes than a welded one.
struct StoredSlots {
    std::vector<std::uint32_t> code;     ///< of each vertex: 0 the next slot, c that of c slots ago
    std::vector<Vec3> position, normal;  ///< of slots
    std::vector<Openness> openness;      ///< of slots; empty without any
    std::vector<std::uint32_t> index;    ///< less the one before it, modulo 2^32
};

/// Precondition: asset.slots is not empty, and sound: vertices of primitives follow each other.
StoredSlots store_slots(const AssetView& asset);

/// Bytes that restore_slots makes of a view as it stands in a file.
std::size_t restored_size(const AssetView& stored);

/// Makes of a view as it stands in a file (slots.slot has the codes, openness and MESH are as in
/// StoredSlots) that of vertices. The arrays lie in `bytes` of the size above, aligned to 4. What
/// it finds is a fault of the file; the view is then of no use.
Fault restore_slots(AssetView& view, std::span<std::byte> bytes);

}  // namespace opaline::formats
