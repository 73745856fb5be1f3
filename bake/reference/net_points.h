#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace opaline::bake {

/// Points of the first (0, 4, 2)-net of the Sobol sequence.
inline constexpr std::uint32_t kNetPoints = 16;

/// 64 bits that pass for independent of those of other keys (the finaliser of splitmix64).
inline std::uint64_t mix_bits(std::uint64_t x) {
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

/// Four binary digits, each flipped by a bit that depends on those before it [Owen1995]; `flips`:
/// 15 random bits. A bijection of 0 to 15 that maps aligned blocks to aligned blocks.
inline std::uint32_t scramble_digits(std::uint32_t digits, std::uint64_t flips) {
    const auto flip = [&](std::uint32_t bit) {
        return static_cast<std::uint32_t>(flips >> bit) & 1;
    };
    return digits ^ (flip(0) << 3 | flip(1 + (digits >> 3)) << 2 | flip(3 + (digits >> 2)) << 1 |
                     flip(7 + (digits >> 1)));
}

/// The i-th of 16 points in [0, 1)^2, 24 bits each: Owen-scrambled Sobol points in an order that is
/// scrambled as well, so that points with the same i of different pairs are independent. Each is
/// uniform over the square. Of the first 2^k, one lies in every elementary interval of area 2^-k:
/// of four, one in each quadrant, each vertical and each horizontal strip. i < 16.
inline glm::vec2 net_point(std::uint64_t key, std::uint32_t pair, std::uint32_t i) {
    constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15u;
    // Digits of both dimensions, the first one highest: the index reversed, and by Pascal's
    // triangle modulo 2, whose columns are 1, 11, 101, 1111.
    constexpr std::array<std::uint32_t, 16> kFirst{0, 8, 4, 12, 2, 10, 6, 14,
                                                   1, 9, 5, 13, 3, 11, 7, 15};
    constexpr std::array<std::uint32_t, 16> kSecond{0,  8, 12, 4,  10, 2,  6, 14,
                                                    15, 7, 3,  11, 5,  13, 9, 1};
    const std::uint64_t flips = mix_bits(key + kGolden * (2 * std::uint64_t{pair} + 1));
    // Below the fourth digit every point has digits of its own.
    const std::uint64_t rest =
        mix_bits(mix_bits(key + kGolden * (2 * std::uint64_t{pair} + 2)) + i);
    const std::uint32_t place = scramble_digits(i, flips);
    const std::uint32_t x = scramble_digits(kFirst[place], flips >> 15);
    const std::uint32_t y = scramble_digits(kSecond[place], flips >> 30);
    constexpr std::uint32_t kLow = (1u << 20) - 1;
    const auto low = [&](int shift) { return static_cast<std::uint32_t>(rest >> shift) & kLow; };
    return {static_cast<float>(x << 20 | low(0)) * 0x1p-24f,
            static_cast<float>(y << 20 | low(32)) * 0x1p-24f};
}

}  // namespace opaline::bake
