#include "formats/opal/slots_file.h"

#include "formats/opal/array_cutter.h"

namespace opaline::formats {
namespace {

struct SlotArrays {
    std::span<std::uint32_t> offset, slot, vertex;
};

// The slots, or places, that codes stand for.
Fault decode_slots(std::span<const PrimitiveRecord> primitives, std::span<const std::uint32_t> code,
                   const SlotArrays& to) {
    std::size_t next_vertex = 0;
    std::uint32_t next = 0;
    for (std::size_t p = 0; p < primitives.size(); ++p) {
        const std::string where = "section SHAR, primitive " + number_in_fault(p);
        if (primitives[p].first_vertex != next_vertex ||
            primitives[p].vertex_count > code.size() - next_vertex) {
            return {where, "its vertices do not follow those of the one before it"};
        }
        const std::uint32_t first = to.offset[p] = next;
        for (const std::uint32_t c : code.subspan(next_vertex, primitives[p].vertex_count)) {
            if (c > next - first || (c == 0 && next == to.vertex.size())) {
                return {where, "it has more slots than there are, or one of another primitive"};
            }
            if (c == 0) to.vertex[next] = static_cast<std::uint32_t>(next_vertex);
            to.slot[next_vertex++] = c == 0 ? next++ : next - c;
        }
    }
    to.offset.back() = next;
    return next_vertex == code.size() && next == to.vertex.size()
               ? Fault{}
               : Fault{"section SHAR", "it has vertices or slots of no primitive"};
}

// Number of the first vertex of each place.
std::vector<std::uint32_t> first_of_places(const SlotsView& slots) {
    if (slots.mix.empty()) return {slots.vertex.begin(), slots.vertex.end()};
    std::vector<std::uint32_t> first;
    for (std::uint32_t v = 0; v < slots.place.size(); ++v) {
        if (slots.place[v] == first.size()) first.push_back(v);
    }
    return first;
}

bool is_slot(const SlotMix& stored) {
    return stored.weight[0] == 0 && stored.weight[1] == 0 && stored.weight[2] == 0;
}

// Of each place as it stands in a file. `before`: slots of places before it.
SlotMix store_mix(const SlotMix& mix, std::uint32_t before) {
    if (mix.is_one()) return {};
    SlotMix stored = mix;
    for (std::uint32_t& slot : stored.slot) {
        slot -= before;
    }
    return stored;
}

// Makes places of a primitive's own into `mix`; `offset` .. `end`: its slots.
bool restore_mixes(std::span<const SlotMix> stored, std::uint32_t offset, std::uint32_t end,
                   std::span<SlotMix> mix) {
    std::uint32_t next = offset;
    for (std::size_t i = 0; i < stored.size(); ++i) {
        const std::uint8_t* const w = stored[i].weight;
        mix[i] = stored[i];
        if (is_slot(stored[i])) {
            mix[i] = {{next, next, next}, {255, 0, 0, 0}};
            ++next;
            continue;
        }
        for (std::uint32_t& slot : mix[i].slot) {
            slot += next;
            if (slot < offset || slot >= end) return false;
        }
        if (w[0] + w[1] + w[2] != 255 || w[0] == 255 || w[1] > w[0] || w[2] > w[0] || w[3] != 0) {
            return false;
        }
    }
    return true;
}

template <class T>
std::vector<T> pick(std::span<const T> of_vertices, std::span<const std::uint32_t> vertices) {
    std::vector<T> picked;
    picked.reserve(vertices.size());
    for (const std::uint32_t v : vertices) {
        picked.push_back(of_vertices[v]);
    }
    return picked;
}

template <class T>
std::span<const T> spread(std::span<const T> of_slots, std::span<const std::uint32_t> slot,
                          std::span<T> of_vertices) {
    for (std::size_t v = 0; v < of_vertices.size(); ++v) {
        of_vertices[v] = of_slots[slot[v]];
    }
    return of_vertices;
}

}  // namespace

StoredSlots store_slots(const AssetView& asset) {
    const SlotsView& slots = asset.slots;
    const std::span<const std::uint32_t> places = slots.mix.empty() ? slots.slot : slots.place;
    StoredSlots stored;
    stored.code.reserve(places.size());
    std::uint32_t next = 0;
    for (const std::uint32_t place : places) {
        stored.code.push_back(next - place);
        next += place == next ? 1 : 0;
    }
    const std::vector<std::uint32_t> first = first_of_places(slots);
    stored.position = pick(asset.position, first);
    stored.normal = pick(asset.normal, first);
    if (!asset.openness.empty()) stored.openness = pick(asset.openness, first);
    std::uint32_t before = 0;
    for (const std::uint32_t vertex : first) {
        if (slots.mix.empty()) break;
        stored.mix.push_back(store_mix(slots.mix[vertex], before));
        before += slots.mix[vertex].is_one() ? 1 : 0;
    }
    stored.index.reserve(asset.index.size());
    std::uint32_t previous = 0;
    for (const std::uint32_t index : asset.index) {
        stored.index.push_back(index - previous);
        previous = index;
    }
    return stored;
}

std::size_t restored_size(const AssetView& stored) {
    const std::size_t vertices = stored.slots.slot.size();
    const std::size_t words = stored.primitives.size() + 1 + vertices + stored.position.size() +
                              stored.index.size() + (stored.openness.empty() ? 0 : vertices);
    const std::size_t mixed =
        stored.slots.mix.empty()
            ? 0
            : (stored.primitives.size() + 1 + stored.slots.mix.size()) * sizeof(std::uint32_t) +
                  (stored.slots.mix.size() + vertices) * sizeof(SlotMix) +
                  vertices * sizeof(std::uint32_t);
    return 4 * words + vertices * (sizeof(Vec3) + sizeof(Vec3)) + mixed;
}

namespace {

// Of places, which `view.slots` has, makes slots and what vertices are mixed of.
Fault restore_mixed(AssetView& view, std::span<const SlotMix> stored, ArrayCutter& cutter) {
    const SlotsView places = view.slots;
    if (stored.size() != places.vertex.size()) {
        return {"section MIXR", "its places are not those of SHAR"};
    }
    const std::span<std::uint32_t> offset = cutter.take<std::uint32_t>(places.offset.size());
    const std::span<SlotMix> of_place = cutter.take<SlotMix>(stored.size());
    const std::span<std::uint32_t> first = cutter.take<std::uint32_t>(stored.size());
    std::uint32_t next = 0;
    for (std::size_t p = 0; p < view.primitives.size(); ++p) {
        offset[p] = next;
        const std::size_t begin = places.offset[p], count = places.count(p);
        for (std::size_t place = begin; place < begin + count; ++place) {
            if (is_slot(stored[place])) first[next++] = places.vertex[place];
        }
        const std::string where = "section MIXR, primitive " + number_in_fault(p);
        if (next - offset[p] < count && view.primitives[p].shading != Shading::diffuse) {
            return {where, "what its vertices show depends on the view: none can be mixed"};
        }
        if (!restore_mixes(stored.subspan(begin, count), offset[p], next,
                           of_place.subspan(begin, count))) {
            return {where,
                    "a vertex is mixed of slots that are not there, or weights that are not "
                    "those of a mean"};
        }
    }
    offset.back() = next;
    const std::span<std::uint32_t> slot = cutter.take<std::uint32_t>(places.slot.size());
    const std::span<SlotMix> mix = cutter.take<SlotMix>(places.slot.size());
    for (std::size_t v = 0; v < slot.size(); ++v) {
        mix[v] = of_place[places.slot[v]];
        slot[v] = mix[v].slot[0];
    }
    view.slots = {offset, slot, first.first(next), mix, places.slot};
    return {};
}

}  // namespace

Fault restore_slots(AssetView& view, std::span<std::byte> bytes) {
    const std::span<const std::uint32_t> code = view.slots.slot;
    const std::span<const SlotMix> mix = view.slots.mix;
    const std::size_t slots = view.position.size();
    if (view.base_color.size() != code.size() || view.normal.size() != slots ||
        (!view.openness.empty() && view.openness.size() != slots)) {
        return {"section SHAR", "its vertices or slots are not those of MESH or SPEC"};
    }
    ArrayCutter cutter(bytes);
    const SlotArrays to{cutter.take<std::uint32_t>(view.primitives.size() + 1),
                        cutter.take<std::uint32_t>(code.size()), cutter.take<std::uint32_t>(slots)};
    if (Fault fault = decode_slots(view.primitives, code, to); !is_sound(fault)) return fault;
    view.slots = {to.offset, to.slot, to.vertex, {}, {}};
    view.position = spread(view.position, to.slot, cutter.take<Vec3>(code.size()));
    view.normal = spread(view.normal, to.slot, cutter.take<Vec3>(code.size()));
    if (!view.openness.empty()) {
        view.openness = spread(view.openness, to.slot, cutter.take<Openness>(code.size()));
    }
    const std::span<std::uint32_t> index = cutter.take<std::uint32_t>(view.index.size());
    std::uint32_t before = 0;
    for (std::size_t i = 0; i < index.size(); ++i) {
        index[i] = before += view.index[i];
    }
    view.index = index;
    return mix.empty() ? Fault{} : restore_mixed(view, mix, cutter);
}

}  // namespace opaline::formats
