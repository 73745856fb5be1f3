#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// Three values in [-1, 1] in four bytes: mantissas of 8 bits and a sign, and one exponent of 5
/// bits. Error at most 2^-8 of the largest magnitude of the three, down to 2^-31. Not negative
/// (`has_sign` false): mantissas of 9 bits, 2^-9. NaN is not allowed.
inline std::uint32_t pack_shared_exponent(const std::array<float, 3>& value, bool has_sign) {
    constexpr int kSmallest = 31;
    const int bits = has_sign ? 8 : 9;
    const float most = has_sign ? 255.0f : 511.0f;
    const float largest = std::max({std::abs(value[0]), std::abs(value[1]), std::abs(value[2])});
    // largest = f 2^exponent, f in [1/2, 1); anything small for 0. No call of frexp or ldexp: there
    // are as many values to pack as there are results.
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(largest) >> 23) - 126;
    const int e = std::clamp(-exponent, 0, kSmallest);
    const float scale = std::bit_cast<float>(static_cast<std::uint32_t>(127 + e + bits) << 23);
    std::uint32_t packed = static_cast<std::uint32_t>(e);
    for (std::size_t c = 0; c < 3; ++c) {
        const float magnitude = std::min(most, std::abs(value[c]) * scale + 0.5f);
        const std::uint32_t sign = value[c] < 0 ? 256u : 0u;
        packed |= (static_cast<std::uint32_t>(magnitude) | (has_sign ? sign : 0u)) << (5 + 9 * c);
    }
    return packed;
}

inline std::array<float, 3> unpack_shared_exponent(std::uint32_t packed, bool has_sign) {
    const std::uint32_t bits = has_sign ? 8 : 9;
    const float unit = std::bit_cast<float>((127 - bits - (packed & 31u)) << 23);  // 2^-(e + bits)
    std::array<float, 3> value;
    for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t code = (packed >> (5 + 9 * c)) & 511u;
        value[c] = !has_sign            ? unit * static_cast<float>(code)
                   : (code & 256u) != 0 ? -unit * static_cast<float>(code & 255u)
                                        : unit * static_cast<float>(code);
    }
    return value;
}

/// Transport of many receivers, gathered texel by texel and read receiver by receiver. The first
/// term is never negative and packed without a sign.
struct PackedRows {
    std::uint32_t texels = 0;
    std::vector<float> largest_term;   ///< [term]: what a value of 1 stands for, times scale
    std::vector<std::uint32_t> place;  ///< [receiver]: where it stands below, neighbours together
    std::vector<float> scale;          ///< [place]
    std::vector<std::vector<std::uint32_t>> packed;  ///< [texel][place][term], 4 bytes each
};

/// How many receivers of `terms` terms fit into `bytes` of memory; at least 1.
inline std::size_t packed_rows_in(std::size_t bytes, std::uint32_t texels, std::uint32_t terms) {
    return std::max<std::size_t>(1, bytes / (std::size_t{texels} * terms * sizeof(std::uint32_t)));
}

/// The row of one receiver: term by term red, then green, then blue; 3 * terms * texels values.
/// Any thread may read.
inline void read_packed_row(const PackedRows& rows, std::size_t receiver,
                            std::span<float> transport) {
    const std::size_t terms = rows.largest_term.size(), place = rows.place[receiver];
    for (std::size_t j = 0; j < rows.texels; ++j) {
        const std::uint32_t* const packed = &rows.packed[j][place * terms];
        for (std::size_t k = 0; k < terms; ++k) {
            const auto value = unpack_shared_exponent(packed[k], k > 0);
            const float scale = rows.scale[place] * rows.largest_term[k];
            for (std::size_t c = 0; c < 3; ++c) {
                transport[(3 * k + c) * rows.texels + j] = scale * value[c];
            }
        }
    }
}

}  // namespace opaline::bake
