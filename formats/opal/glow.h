#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/rgb.h"

namespace opaline::formats {

/// Light that volumes send out by themselves; formats/README.md, `GLOW`.

/// Of one volume and one emitter: radiance per metre in bricks of the volume, if it is its own
/// light, and what its nodes scatter of all light of the emitter. Fixed size, stored as is.
struct GlowRecord {
    std::uint32_t volume = 0, emitter = 0;           ///< numbers of VOLU and EMIT
    std::uint64_t first_value = 0;                   ///< 3 node_count terms of them
    float value_scale = 0;                           ///< >= 0, finite
    std::uint32_t terms = 0;                         ///< K_e: 0, 1, 4, 9, 16 or 25
    std::uint32_t first_brick = 0, brick_count = 0;  ///< among GlowView::brick
    float code_scale = 0;                            ///< >= 0, finite
    std::uint32_t reserved[3] = {};
};
static_assert(sizeof(GlowRecord) == 48);

/// All of an asset as spans, into the bytes of a file or into `Glow`. Immutable.
struct GlowView {
    std::span<const GlowRecord> record;    ///< by volume, then emitter; no pair twice
    std::span<const std::uint32_t> brick;  ///< numbers of bricks that glow, counted from the
                                           ///< volume's first one; ascending within a record
    std::span<const std::uint32_t> code;   ///< 512 a brick, x fastest: half.h
    std::span<const std::uint16_t> value;  ///< halves: R, G, B of term after term, node after node

    bool empty() const { return record.empty(); }
    /// The records of a volume.
    std::span<const GlowRecord> of_volume(std::size_t volume) const {
        std::size_t first = 0, end = record.size();
        while (first < end && record[first].volume != volume)
            ++first;
        while (end > first && record[end - 1].volume != volume)
            --end;
        return record.subspan(first, end - first);
    }
    /// The one of its own light. Null: the volume sends out nothing.
    const GlowRecord* own_of(std::size_t volume) const {
        for (const GlowRecord& each : of_volume(volume)) {
            if (each.brick_count > 0) return &each;
        }
        return nullptr;
    }
};

/// Owning twin of `GlowView`: what the baker builds.
struct Glow {
    std::vector<GlowRecord> record;
    std::vector<std::uint32_t> brick;
    std::vector<std::uint32_t> code;
    std::vector<std::uint16_t> value;

    GlowView view() const { return {record, brick, code, value}; }
};

}  // namespace opaline::formats
