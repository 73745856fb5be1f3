#include "runtime/embed_gl/spread_batches.h"

#include <algorithm>

namespace opaline::runtime {
namespace {

SpreadBatch bind_batch(std::uint32_t first, std::uint32_t vertices, std::uint32_t least,
                       std::uint32_t greatest, std::size_t alignment) {
    SpreadBatch batch;
    batch.vertices = vertices;
    batch.least_slot = least;
    batch.slot = bind_elements(first, vertices, sizeof(std::uint32_t), alignment);
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

std::vector<SpreadBatch> plan_spread_batches(const formats::AssetView& asset,
                                             const DotLimits& limits) {
    std::vector<SpreadBatch> batches;
    if (asset.slots.empty()) return batches;
    for (std::uint32_t p = 0; p < asset.primitives.size(); ++p) {
        const formats::PrimitiveRecord& primitive = asset.primitives[p];
        const auto slot = asset.slots.slot.subspan(primitive.first_vertex, primitive.vertex_count);
        for (std::uint32_t begin = 0; begin < slot.size();) {
            std::uint32_t least = slot[begin], greatest = slot[begin], count = 1;
            const auto batch_of = [&](std::uint32_t vertices) {
                return bind_batch(primitive.first_vertex + begin, vertices, least, greatest,
                                  limits.alignment);
            };
            SpreadBatch batch = batch_of(count);
            while (begin + count < slot.size()) {
                least = std::min(least, slot[begin + count]);
                greatest = std::max(greatest, slot[begin + count]);
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
