#include "formats/opal/glow_arrays.h"

#include "formats/opal/volumes.h"

namespace opaline::formats {

GlowHead glow_head(const GlowView& glow) {
    return {static_cast<std::uint32_t>(glow.record.size()),
            sizeof(GlowRecord),
            glow.brick.size(),
            glow.value.size(),
            {}};
}

std::array<std::span<const std::byte>, 5> glow_arrays(const GlowHead& head, const GlowView& glow) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(glow.record),
            std::as_bytes(glow.brick), std::as_bytes(glow.code), std::as_bytes(glow.value)};
}

bool take_glow(SectionCursor& cursor, GlowView& glow) {
    GlowHead head;
    // Numbers come before codes: where there are as many as bricks, 512 times that cannot overflow.
    return cursor.take_one(head) && head.record_size == sizeof(GlowRecord) &&
           cursor.take(head.count, glow.record) && cursor.take(head.bricks, glow.brick) &&
           cursor.take(head.bricks * kBrickVoxels, glow.code) &&
           cursor.take(head.values, glow.value);
}

}  // namespace opaline::formats
