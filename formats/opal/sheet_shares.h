#pragma once

#include <cstdint>

#include "formats/opal/half.h"
#include "formats/opal/normal_maps.h"
#include "formats/opal/rgb.h"

namespace opaline::formats {

/// The shares of light that a thin-walled surface reflects and transmits, each in [0, 1]: what a
/// reader needs to turn its light to the normals of a map. They stand in the record of the map, as
/// halves: formats/README.md, `NORM`.
struct SheetShares {
    Rgb reflect, transmit;

    bool any() const {
        return reflect.r + reflect.g + reflect.b + transmit.r + transmit.g + transmit.b > 0;
    }
};

/// Of `NORM`, where a record has them.
inline constexpr std::uint32_t kMappedSheetVersion = 2;
inline constexpr std::uint16_t kHalfOfOne = 0x3c00;

/// Precondition: each in [0, 1].
inline void store_sheet_shares(const SheetShares& shares, NormalMapRecord& map) {
    const auto pair = [](float low, float high) {
        return std::uint32_t{half_from_float(low)} | std::uint32_t{half_from_float(high)} << 16;
    };
    map.reserved[0] = pair(shares.reflect.r, shares.reflect.g);
    map.reserved[1] = pair(shares.reflect.b, shares.transmit.r);
    map.reserved[2] = pair(shares.transmit.g, shares.transmit.b);
}

inline SheetShares sheet_shares_of(const NormalMapRecord& map) {
    const auto value = [&](int i) {
        return float_from_half(static_cast<std::uint16_t>(map.reserved[i / 2] >> (16 * (i % 2))));
    };
    return {{value(0), value(1), value(2)}, {value(3), value(4), value(5)}};
}

}  // namespace opaline::formats
