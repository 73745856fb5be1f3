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

/// One value for each of one or three bands.
template <std::size_t kBands>
using BandValues = std::array<float, kBands>;

/// Values in [-1, 1], three in four bytes or one in two: mantissas of 8 bits and a sign, and one
/// exponent of 5 bits for all. The error is at most 2^-8 of the largest magnitude among them, down
/// to 2^-31. Without sign (`has_sign` false), mantissas have 9 bits and the error is 2^-9. NaN is
/// not allowed.
template <std::size_t kBands>
std::uint32_t pack_values(const BandValues<kBands>& value, bool has_sign) {
    constexpr int kSmallest = 31;
    const int bits = has_sign ? 8 : 9;
    const float most = has_sign ? 255.0f : 511.0f;
    float largest = 0;
    for (const float v : value) {
        largest = std::max(largest, std::abs(v));
    }
    // largest = f 2^exponent, f in [1/2, 1); a small exponent for 0. frexp and ldexp would be too
    // slow: every result is packed.
    const int exponent = static_cast<int>(std::bit_cast<std::uint32_t>(largest) >> 23) - 126;
    const int e = std::clamp(-exponent, 0, kSmallest);
    const float scale = std::bit_cast<float>(static_cast<std::uint32_t>(127 + e + bits) << 23);
    std::uint32_t packed = static_cast<std::uint32_t>(e);
    for (std::size_t c = 0; c < kBands; ++c) {
        const float magnitude = std::min(most, std::abs(value[c]) * scale + 0.5f);
        const std::uint32_t sign = value[c] < 0 ? 256u : 0u;
        packed |= (static_cast<std::uint32_t>(magnitude) | (has_sign ? sign : 0u)) << (5 + 9 * c);
    }
    return packed;
}

template <std::size_t kBands>
BandValues<kBands> unpack_values(std::uint32_t packed, bool has_sign) {
    const std::uint32_t bits = has_sign ? 8 : 9;
    const float unit = std::bit_cast<float>((127 - bits - (packed & 31u)) << 23);  // 2^-(e + bits)
    BandValues<kBands> value;
    for (std::size_t c = 0; c < kBands; ++c) {
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
    std::uint32_t bands = 3;           ///< or 1
    std::vector<float> largest_term;   ///< [term]: the value that 1 stands for, before scale
    std::vector<std::uint32_t> place;  ///< [receiver]: index into scale and packed, spatial order
    std::vector<float> scale;          ///< [place]
    /// [texel][place][term]: one word for one band; two words, the lower first, for three bands.
    std::vector<std::vector<std::uint16_t>> packed;
};

/// Words that the value of a term takes.
constexpr std::size_t packed_words(std::uint32_t bands) {
    return bands == 1 ? 1 : 2;
}

/// Number of receivers with `terms` terms that fit into `bytes` of memory; at least 1.
inline std::size_t packed_rows_in(std::size_t bytes, std::uint32_t texels, std::uint32_t terms,
                                  std::uint32_t bands) {
    return std::max<std::size_t>(
        1, bytes / (std::size_t{texels} * terms * packed_words(bands) * sizeof(std::uint16_t)));
}

template <std::size_t kBands>
void store_packed(std::uint32_t packed, std::uint16_t* words) {
    words[0] = static_cast<std::uint16_t>(packed);
    if constexpr (kBands == 3) {
        words[1] = static_cast<std::uint16_t>(packed >> 16);
    }
}

template <std::size_t kBands>
std::uint32_t load_packed(const std::uint16_t* words) {
    if constexpr (kBands == 3) {
        return words[0] | static_cast<std::uint32_t>(words[1]) << 16;
    } else {
        return words[0];
    }
}

template <std::size_t kBands>
void read_packed_bands(const PackedRows& rows, std::size_t receiver, std::span<float> transport) {
    constexpr std::size_t kWords = packed_words(kBands);
    const std::size_t terms = rows.largest_term.size(), place = rows.place[receiver];
    for (std::size_t j = 0; j < rows.texels; ++j) {
        const std::uint16_t* const packed = &rows.packed[j][place * terms * kWords];
        for (std::size_t k = 0; k < terms; ++k) {
            const auto value =
                unpack_values<kBands>(load_packed<kBands>(packed + kWords * k), k > 0);
            const float scale = rows.scale[place] * rows.largest_term[k];
            for (std::size_t c = 0; c < kBands; ++c) {
                transport[(kBands * k + c) * rows.texels + j] = scale * value[c];
            }
        }
    }
}

/// The row of one receiver: term by term band by band; bands * terms * texels values. Any thread
/// may read.
inline void read_packed_row(const PackedRows& rows, std::size_t receiver,
                            std::span<float> transport) {
    rows.bands == 1 ? read_packed_bands<1>(rows, receiver, transport)
                    : read_packed_bands<3>(rows, receiver, transport);
}

}  // namespace opaline::bake
