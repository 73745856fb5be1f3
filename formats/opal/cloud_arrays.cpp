#include "formats/opal/cloud_arrays.h"

namespace opaline::formats {

CloudsHead clouds_head(const CloudsView& clouds) {
    return {static_cast<std::uint32_t>(clouds.records.size()),
            sizeof(LayerRecord),
            clouds.thickness.size(),
            clouds.ground.size(),
            clouds.value.size(),
            {}};
}

std::array<std::span<const std::byte>, 5> cloud_arrays(const CloudsHead& head,
                                                       const CloudsView& clouds) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(clouds.records),
            std::as_bytes(clouds.thickness), std::as_bytes(clouds.ground),
            std::as_bytes(clouds.value)};
}

bool take_clouds(SectionCursor& cursor, CloudsView& clouds) {
    CloudsHead head;
    return cursor.take_one(head) && head.record_size == sizeof(LayerRecord) &&
           cursor.take(head.count, clouds.records) &&
           cursor.take(head.thickness, clouds.thickness) &&
           cursor.take(head.ground, clouds.ground) && cursor.take(head.values, clouds.value);
}

}  // namespace opaline::formats
