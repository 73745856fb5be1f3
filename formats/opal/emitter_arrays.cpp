#include "formats/opal/emitter_arrays.h"

namespace opaline::formats {

EmittersHead emitters_head(const EmittersView& emitters) {
    return {emitters.size(),
            static_cast<std::uint32_t>(emitters.text.size()),
            static_cast<std::uint32_t>(emitters.own.size()),
            sizeof(OwnLight),
            emitters.block.size(),
            emitters.value.size(),
            sizeof(EmitterBlock),
            {}};
}

std::array<std::span<const std::byte>, 6> emitter_arrays(const EmittersHead& head,
                                                         const EmittersView& emitters) {
    return {std::as_bytes(std::span(&head, 1)), std::as_bytes(emitters.name_end),
            std::as_bytes(emitters.text),       std::as_bytes(emitters.block),
            std::as_bytes(emitters.own),        std::as_bytes(emitters.value)};
}

bool take_emitters(SectionCursor& cursor, EmittersView& emitters) {
    EmittersHead head;
    return cursor.take_one(head) && head.own_size == sizeof(OwnLight) &&
           head.block_size == sizeof(EmitterBlock) && cursor.take(head.count, emitters.name_end) &&
           cursor.take(head.text, emitters.text) && cursor.take(head.blocks, emitters.block) &&
           cursor.take(head.own, emitters.own) && cursor.take(head.values, emitters.value);
}

}  // namespace opaline::formats
