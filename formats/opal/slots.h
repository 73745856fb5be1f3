#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::formats {

/// Which vertices share rows: all of one place and one normal of a primitive have the same
/// transport. Such vertices have one slot; rows belong to slots.
struct SlotsView {
    /// Primitive p has the slots offset[p] .. offset[p + 1] - 1 of the asset. Empty: no vertex
    /// shares its rows, and each is a slot by itself.
    std::span<const std::uint32_t> offset;
    std::span<const std::uint32_t> slot;    ///< of each vertex; numbered as they appear
    std::span<const std::uint32_t> vertex;  ///< of each slot: the first vertex that has it

    bool empty() const { return offset.empty(); }
    /// Slots of a primitive. Precondition: not empty.
    std::uint32_t count(std::size_t primitive) const {
        return offset[primitive + 1] - offset[primitive];
    }
};

/// Owning twin of `SlotsView`.
struct Slots {
    std::vector<std::uint32_t> offset, slot, vertex;

    bool empty() const { return offset.empty(); }
    SlotsView view() const { return {offset, slot, vertex}; }
};

}  // namespace opaline::formats
