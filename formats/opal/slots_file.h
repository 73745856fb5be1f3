#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/asset.h"
#include "formats/opal/fault.h"

namespace opaline::formats {

/// Vertices that share rows, as they stand in a file: `SHAR`, `MIXR`, and what is stored of places
/// instead of vertices, so that an unwelded mesh takes hardly more bytes than a welded one. Places
/// are slots where no vertex is mixed.
struct StoredSlots {
    std::vector<std::uint32_t> code;  ///< of each vertex: 0 the next place, c that of c places ago
    /// Of each place, or empty: zeros if it is a slot; else what it is mixed of, slots less the
    /// number of those before it, modulo 2^32.
    std::vector<SlotMix> mix;
    std::vector<Vec3> position, normal;  ///< of places
    std::vector<Openness> openness;      ///< of places; empty without any
    std::vector<std::uint32_t> index;    ///< less the one before it, modulo 2^32
};

/// Precondition: asset.slots is not empty, and sound: vertices of primitives follow each other.
StoredSlots store_slots(const AssetView& asset);

/// Bytes that restore_slots makes of a view as it stands in a file.
std::size_t restored_size(const AssetView& stored);

/// Makes of a view as it stands in a file (slots.slot has the codes, slots.mix, openness and MESH
/// are as in StoredSlots) that of vertices. The arrays lie in `bytes` of the size above, aligned
/// to 4. What it finds is a fault of the file; the view is then of no use.
Fault restore_slots(AssetView& view, std::span<std::byte> bytes);

}  // namespace opaline::formats
