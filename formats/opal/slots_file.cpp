#include "formats/opal/slots_file.h"

namespace opaline::formats {
namespace {

// Hands out arrays of `bytes` one after the other.
class ArrayCutter {
  public:
    explicit ArrayCutter(std::span<std::byte> bytes) : rest_(bytes) {}

    template <class T>
    std::span<T> take(std::size_t count) {
        static_assert(alignof(T) <= 4 && sizeof(T) % 4 == 0);
        const std::span<T> array(reinterpret_cast<T*>(rest_.data()), count);
        rest_ = rest_.subspan(count * sizeof(T));
        return array;
    }

  private:
    std::span<std::byte> rest_;
};

struct SlotArrays {
    std::span<std::uint32_t> offset, slot, vertex;
};

// The slots that codes stand for.
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
    StoredSlots stored;
    stored.code.reserve(slots.slot.size());
    std::uint32_t next = 0;
    for (const std::uint32_t slot : slots.slot) {
        stored.code.push_back(next - slot);
        next += slot == next ? 1 : 0;
    }
    stored.position = pick(asset.position, slots.vertex);
    stored.normal = pick(asset.normal, slots.vertex);
    if (!asset.openness.empty()) stored.openness = pick(asset.openness, slots.vertex);
    stored.index.reserve(asset.index.size());
    std::uint32_t before = 0;
    for (const std::uint32_t index : asset.index) {
        stored.index.push_back(index - before);
        before = index;
    }
    return stored;
}

std::size_t restored_size(const AssetView& stored) {
    const std::size_t vertices = stored.slots.slot.size();
    const std::size_t words = stored.primitives.size() + 1 + vertices + stored.position.size() +
                              stored.index.size() + (stored.openness.empty() ? 0 : vertices);
    return 4 * words + vertices * (sizeof(Vec3) + sizeof(Vec3));
}

Fault restore_slots(AssetView& view, std::span<std::byte> bytes) {
    const std::span<const std::uint32_t> code = view.slots.slot;
    const std::size_t slots = view.position.size();
    if (view.base_color.size() != code.size() || view.normal.size() != slots ||
        (!view.openness.empty() && view.openness.size() != slots)) {
        return {"section SHAR", "its vertices or slots are not those of MESH or SPEC"};
    }
    ArrayCutter cutter(bytes);
    const SlotArrays to{cutter.take<std::uint32_t>(view.primitives.size() + 1),
                        cutter.take<std::uint32_t>(code.size()), cutter.take<std::uint32_t>(slots)};
    if (Fault fault = decode_slots(view.primitives, code, to); !is_sound(fault)) return fault;
    view.slots = {to.offset, to.slot, to.vertex};
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
    return {};
}

}  // namespace opaline::formats
