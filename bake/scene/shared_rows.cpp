#include "bake/scene/shared_rows.h"

#include <cstddef>
#include <glm/glm.hpp>
#include <unordered_map>
#include <utility>

#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

struct PlaceAndNormal {
    glm::vec3 place, normal;

    bool operator==(const PlaceAndNormal&) const = default;
};

struct PlaceAndNormalHash {
    std::size_t operator()(const PlaceAndNormal& at) const {
        const PositionHash hash;
        return hash(at.place) * 31 + hash(at.normal);
    }
};

}  // namespace

formats::Slots find_slots(const formats::Scene& scene) {
    formats::Slots slots;
    slots.offset.push_back(0);
    std::unordered_map<PlaceAndNormal, std::uint32_t, PlaceAndNormalHash> slot_of;
    for (const formats::Primitive& p : scene.primitives) {
        slot_of.clear();
        slot_of.reserve(p.position.size());
        for (std::size_t v = 0; v < p.position.size(); ++v) {
            const auto next = static_cast<std::uint32_t>(slots.vertex.size());
            const auto [found, is_new] =
                slot_of.try_emplace({weld_key(p.position[v]), weld_key(p.normal[v])}, next);
            if (is_new) slots.vertex.push_back(static_cast<std::uint32_t>(slots.slot.size()));
            slots.slot.push_back(found->second);
        }
        slots.offset.push_back(static_cast<std::uint32_t>(slots.vertex.size()));
    }
    return slots.vertex.size() < slots.slot.size() ? std::move(slots) : formats::Slots{};
}

formats::Slots places_of(const formats::Scene& scene, formats::Slots slots) {
    if (slots.mix.empty()) return slots;
    formats::Slots places;
    std::uint32_t vertex = 0;
    for (const formats::Primitive& p : scene.primitives) {
        places.offset.push_back(static_cast<std::uint32_t>(places.vertex.size()));
        for (const std::uint32_t end = vertex + static_cast<std::uint32_t>(p.position.size());
             vertex < end; ++vertex) {
            if (slots.place[vertex] == places.vertex.size()) places.vertex.push_back(vertex);
        }
    }
    places.offset.push_back(static_cast<std::uint32_t>(places.vertex.size()));
    places.slot = std::move(slots.place);
    return places;
}

std::uint32_t count_receivers_of(const formats::Scene& scene, const formats::SlotsView& slots,
                                 std::size_t primitive) {
    return slots.empty() ? static_cast<std::uint32_t>(scene.primitives[primitive].position.size())
                         : slots.count(primitive);
}

formats::Scene merge_vertices(const formats::Scene& scene, const formats::SlotsView& slots) {
    formats::Scene merged;
    merged.materials = scene.materials;
    merged.origin = scene.origin;
    merged.primitives.reserve(scene.primitives.size());
    std::uint32_t first_vertex = 0;
    for (std::size_t number = 0; number < scene.primitives.size(); ++number) {
        const formats::Primitive& from = scene.primitives[number];
        const std::uint32_t first_slot = slots.offset[number];
        formats::Primitive& to = merged.primitives.emplace_back();
        to.material = from.material;
        to.position.reserve(slots.count(number));
        to.normal.reserve(slots.count(number));
        const std::size_t given = from.position.size() - from.added.size();
        for (const std::uint32_t vertex : slots.vertex.subspan(first_slot, slots.count(number))) {
            const std::uint32_t own = vertex - first_vertex;
            to.position.push_back(from.position[own]);
            to.normal.push_back(from.normal[own]);
            if (own < given) continue;
            to.added.push_back(from.added[own - given]);  // the last slots
            for (std::uint32_t& corner : to.added.back().corner) {
                corner = slots.slot[first_vertex + corner] - first_slot;
            }
        }
        to.index.reserve(from.index.size());
        for (const std::uint32_t corner : from.index) {
            to.index.push_back(slots.slot[first_vertex + corner] - first_slot);
        }
        first_vertex += static_cast<std::uint32_t>(from.position.size());
    }
    return merged;
}

}  // namespace opaline::bake
