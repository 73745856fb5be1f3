#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "formats/opal/slots.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Vertices of one place and one normal of a primitive have the same transport, however often an
/// unwelded, flat-shaded or seamed mesh repeats them: they share a slot, and receivers are slots.
/// -0 and +0 are the same. Empty where no two vertices do.
formats::Slots find_slots(const formats::Scene& scene);

/// The places and normals of vertices of which some are mixed, as if each were a slot. `slots`
/// itself where none is.
formats::Slots places_of(const formats::Scene& scene, formats::Slots slots);

/// Receivers of a primitive: its slots, or its vertices where `slots` is empty.
std::uint32_t count_receivers_of(const formats::Scene& scene, const formats::SlotsView& slots,
                                 std::size_t primitive);

/// The scene as receivers are placed in it: primitives have one vertex for each slot, with its
/// position and normal, which of them were added, and the same triangles. Of all else only
/// materials and the origin are there. Precondition: `slots` is not empty.
formats::Scene merge_vertices(const formats::Scene& scene, const formats::SlotsView& slots);

/// What each vertex has of what its slot has; a mixed one of that of the largest weight.
template <class T>
std::vector<T> spread_to_vertices(const formats::SlotsView& slots, std::vector<T> of_slots) {
    if (slots.empty() || of_slots.empty()) return of_slots;
    std::vector<T> of_vertices;
    of_vertices.reserve(slots.slot.size());
    for (const std::uint32_t slot : slots.slot) {
        of_vertices.push_back(of_slots[slot]);
    }
    return of_vertices;
}

}  // namespace opaline::bake
