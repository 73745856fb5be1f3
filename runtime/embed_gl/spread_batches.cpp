#include "runtime/embed_gl/spread_batches.h"

#include <algorithm>

namespace opaline::runtime {
namespace {

// Slots of vertices.
struct SlotRange {
    std::uint32_t least = 0xffffffffu, greatest = 0;

    void add(std::uint32_t slot) {
        least = std::min(least, slot);
        greatest = std::max(greatest, slot);
    }
    void add_of(const formats::SlotsView& slots, std::uint32_t vertex) {
        if (slots.mix.empty()) {
            add(slots.slot[vertex]);
            return;
        }
        for (const std::uint32_t slot : slots.mix[vertex].slot) {
            add(slot);
        }
    }
};

SpreadBatch bind_batch(std::uint32_t first, std::uint32_t vertices, const SlotRange& slots,
                       std::size_t slot_bytes, std::size_t alignment) {
    const auto [least, greatest] = slots;
    SpreadBatch batch;
    batch.vertices = vertices;
    batch.least_slot = least;
    batch.slot = bind_elements(first, vertices, slot_bytes, alignment);
    batch.shown = bind_elements(least, greatest - least + 1, kRadianceBytes, alignment);
    batch.radiance = bind_elements(first, vertices, kRadianceBytes, alignment);
    return batch;
}

bool is_within(const SpreadBatch& batch, const DotLimits& limits) {
    return batch.vertices <= limits.max_vertices &&
           std::max({batch.slot.size, batch.shown.size, batch.radiance.size}) <=
               limits.max_block_bytes;
}

}  // namespace

std::size_t bytes_of_slots(const formats::SlotsView& slots) {
    return slots.mix.empty() ? sizeof(std::uint32_t) : sizeof(formats::SlotMix);
}

std::vector<SpreadBatch> plan_spread_batches(const formats::AssetView& asset,
                                             const DotLimits& limits) {
    std::vector<SpreadBatch> batches;
    if (asset.slots.empty()) return batches;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const std::uint32_t end = primitive.vertex_count;
        for (std::uint32_t begin = 0; begin < end;) {
            const std::uint32_t first = primitive.first_vertex + begin;
            std::uint32_t count = 1;
            SlotRange slots;
            slots.add_of(asset.slots, first);
            const auto batch_of = [&](std::uint32_t vertices) {
                return bind_batch(first, vertices, slots, bytes_of_slots(asset.slots),
                                  limits.alignment);
            };
            SpreadBatch batch = batch_of(count);
            while (begin + count < end) {
                slots.add_of(asset.slots, first + count);
                const SpreadBatch more = batch_of(++count);
                if (!is_within(more, limits)) break;
                batch = more;
            }
            batch.primitive = p;
            batches.push_back(batch);
            begin += batch.vertices;
        }
    }
    return batches;
}

}  // namespace opaline::runtime
