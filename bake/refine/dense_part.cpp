#include "bake/refine/dense_part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace opaline::bake {
namespace {

// 255ths, the first one below all of them: only a slot's own vertex has it alone.
formats::SlotMix quantised(const CoarseMix& mix, std::span<const std::uint32_t> slot_of) {
    formats::SlotMix made;
    const auto part = [&](std::size_t k) {
        return static_cast<std::uint8_t>(std::lround(255 * mix.weight[k]));
    };
    made.weight[2] = std::min<std::uint8_t>(part(2), 85);
    made.weight[1] = std::min<std::uint8_t>(std::max<std::uint8_t>(part(1), made.weight[2]),
                                            static_cast<std::uint8_t>((255 - made.weight[2]) / 2));
    if (made.weight[1] == 0) made.weight[1] = 1;
    made.weight[0] = static_cast<std::uint8_t>(255 - made.weight[1] - made.weight[2]);
    for (std::size_t k = 0; k < mix.vertex.size(); ++k) {
        made.slot[k] = slot_of[mix.vertex[k]];
    }
    return made;
}

}  // namespace

DensePart make_dense_part(const formats::Scene& scene, const formats::Slots& places,
                          std::uint32_t primitive, std::uint32_t first_vertex) {
    const formats::Primitive& p = scene.primitives[primitive];
    const std::uint32_t first = places.offset[primitive],
                        count = places.offset[primitive + 1] - first;
    DensePart part;
    part.primitive = primitive;
    part.first_place = first;
    part.first_vertex = first_vertex;
    constexpr float kFar = std::numeric_limits<float>::infinity();
    glm::vec3 low(kFar), high(-kFar);
    for (std::uint32_t i = first; i < first + count; ++i) {
        const std::uint32_t vertex = places.vertex[i] - first_vertex;
        part.mesh.position.push_back(p.position[vertex]);
        part.mesh.normal.push_back(p.normal[vertex]);
        low = glm::min(low, p.position[vertex]);
        high = glm::max(high, p.position[vertex]);
    }
    part.size = glm::distance(low, high);
    part.at.resize(count, {primitive, formats::kNone, {}});
    for (std::uint32_t i = 0; i < p.index.size(); i += 3) {
        std::array<std::uint32_t, 3> corner{};
        for (std::uint32_t k = 0; k < 3; ++k) {
            corner[k] = places.slot[first_vertex + p.index[i + k]] - first;
            if (part.at[corner[k]].first_index != formats::kNone) continue;
            // A little inside: on an edge rays may start in a wall.
            glm::vec3 weight(0.02f);
            weight[static_cast<glm::length_t>(k)] = 0.96f;
            part.at[corner[k]] = {primitive, i, weight};
        }
        if (corner[0] != corner[1] && corner[1] != corner[2] && corner[2] != corner[0]) {
            part.mesh.triangle.push_back(corner);
        }
    }
    part.outlines.resize(count);
    part.is_asked.resize(count, false);
    return part;
}

bool is_mixed(const DensePart& part, std::uint32_t v) {
    return !part.mix.empty() && part.mix[v].vertex[0] != v;
}

std::size_t count_kept(std::span<const DensePart> parts) {
    std::size_t kept = 0;
    for (const DensePart& part : parts) {
        for (std::uint32_t v = 0; v < part.at.size(); ++v) {
            kept += is_mixed(part, v) ? 0 : 1;
        }
    }
    return kept;
}

formats::Slots make_slots(formats::Slots places, std::span<const DensePart> parts) {
    std::vector<const DensePart*> part_of(places.offset.size() - 1, nullptr);
    for (const DensePart& part : parts) {
        part_of[part.primitive] = &part;
    }
    formats::Slots slots;
    std::vector<formats::SlotMix> of_place;
    slots.offset.push_back(0);
    for (std::size_t p = 0; p < part_of.size(); ++p) {
        const std::uint32_t first = places.offset[p], count = places.offset[p + 1] - first;
        std::vector<std::uint32_t> slot_of(count, formats::kNone);
        for (std::uint32_t i = 0; i < count; ++i) {
            if (part_of[p] != nullptr && is_mixed(*part_of[p], i)) continue;
            slot_of[i] = static_cast<std::uint32_t>(slots.vertex.size());
            slots.vertex.push_back(places.vertex[first + i]);
        }
        for (std::uint32_t i = 0; i < count; ++i) {
            const std::uint32_t own = slot_of[i];
            of_place.push_back(own != formats::kNone
                                   ? formats::SlotMix{{own, own, own}, {255, 0, 0, 0}}
                                   : quantised(part_of[p]->mix[i], slot_of));
        }
        slots.offset.push_back(static_cast<std::uint32_t>(slots.vertex.size()));
    }
    for (const std::uint32_t place : places.slot) {
        slots.mix.push_back(of_place[place]);
        slots.slot.push_back(of_place[place].slot[0]);
    }
    slots.place = std::move(places.slot);
    return slots;
}

}  // namespace opaline::bake
