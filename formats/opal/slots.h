#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::formats {

/// What a vertex shows of its slots: sum over k of weight[k] / 255 times what slot[k] shows. Fixed
/// size; a graphics card reads it as four words.
struct SlotMix {
    std::uint32_t slot[3] = {};   ///< of the same primitive, numbered over the asset
    std::uint8_t weight[4] = {};  ///< the first three add up to 255; the last is 0

    bool is_one() const { return weight[0] == 255; }
};
static_assert(sizeof(SlotMix) == 16);

/// Which vertices share rows: all of one place and one normal of a primitive have the same
/// transport. Such vertices have one slot; rows belong to slots. On dense smooth meshes most
/// vertices have no slot of their own: they are mixed of up to three.
struct SlotsView {
    /// Primitive p has the slots offset[p] .. offset[p + 1] - 1 of the asset. Empty: no vertex
    /// shares its rows, and each is a slot by itself.
    std::span<const std::uint32_t> offset;
    /// Of each vertex: numbered as they appear; of one that is mixed that of the largest weight.
    std::span<const std::uint32_t> slot;
    std::span<const std::uint32_t> vertex;  ///< of each slot: the first vertex that has it alone
    /// Of each vertex; empty: none is mixed.
    std::span<const SlotMix> mix;
    /// Where some are mixed, of each vertex the number of its place and normal, as they appear.
    std::span<const std::uint32_t> place;

    bool empty() const { return offset.empty(); }
    bool is_mixed(std::uint32_t of_vertex) const {
        return !mix.empty() && !mix[of_vertex].is_one();
    }
    /// Slots of a primitive. Precondition: not empty.
    std::uint32_t count(std::size_t primitive) const {
        return offset[primitive + 1] - offset[primitive];
    }
};

/// Owning twin of `SlotsView`.
struct Slots {
    std::vector<std::uint32_t> offset, slot, vertex;
    std::vector<SlotMix> mix;          ///< empty: no vertex is mixed
    std::vector<std::uint32_t> place;  ///< empty as `mix`

    bool empty() const { return offset.empty(); }
    SlotsView view() const { return {offset, slot, vertex, mix, place}; }
};

}  // namespace opaline::formats
