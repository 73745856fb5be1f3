#pragma once

#include <bit>
#include <cstdint>

#include "bake/receivers/receiver.h"

namespace opaline::bake {

/// Key of a receiver's random numbers where it has no number: a hash of its place and normal, so
/// that copies of a vertex draw the same.
inline std::uint64_t key_of(const Receiver& at) {
    std::uint64_t key = 0x9e3779b97f4a7c15u;
    for (const float value :
         {at.origin.x, at.origin.y, at.origin.z, at.normal.x, at.normal.y, at.normal.z}) {
        key = (key ^ std::bit_cast<std::uint32_t>(value)) * 0xff51afd7ed558ccdu;
        key ^= key >> 32;
    }
    return key;
}

}  // namespace opaline::bake
