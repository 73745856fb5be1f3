#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

#include "bake/base/rng.h"

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

/// The random numbers of one path, a pure function of (seed, pixel, sample), so that a path does
/// not depend on thread or order. Those of its first events are stratified: each is uniform and
/// independent of the path's others, but 16 consecutive samples (0 to 15, 16 to 31, ...) of a pixel
/// spread over its domain. Groups of 16 are independent of each other.
class RandomStream {
  public:
    static constexpr std::uint32_t kGroup = kNetPoints;

    RandomStream(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
        : seed_(seed), pixel_(pixel), sample_(sample) {}

    /// Uniform in [0, 1), 24 bits.
    float next() {
        if (dimension_ < end_) {
            if ((dimension_ & 1) == 0) {
                pair_ = net_point(group_key(), dimension_ / 2, sample_ % kGroup);
            }
            return pair_[static_cast<int>(dimension_++ & 1)];
        }
        if (used_ == 4) {
            block_ = random_uniform(seed_, RandomStage::reference_path,
                                    pixel_ | std::uint64_t{blocks_++} << 32, sample_);
            used_ = 0;
        }
        return block_[used_++];
    }

    /// Two numbers that are stratified over the square.
    glm::vec2 next_pair() {
        dimension_ += dimension_ & 1;
        const float u = next();
        return {u, next()};
    }

    /// The next numbers are those of the path's next event. Paths that take the same course then
    /// have the same numbers for the same purpose, whatever else each of them drew.
    void start_event() {
        if (events_ < kEvents) {
            dimension_ = kPerEvent * events_++;
            end_ = dimension_ + kPerEvent;
        } else {
            end_ = 0;
        }
    }

  private:
    static constexpr std::uint32_t kEvents = 5, kPerEvent = 16;

    std::uint64_t group_key() {
        if (!has_key_) {
            const auto words =
                random_bits(seed_, RandomStage::reference_group, pixel_, sample_ / kGroup);
            key_ = words[0] | std::uint64_t{words[1]} << 32;
            has_key_ = true;
        }
        return key_;
    }

    std::uint64_t seed_;
    std::uint32_t pixel_, sample_;
    std::uint32_t blocks_ = 0, used_ = 4;
    std::uint32_t events_ = 0, dimension_ = 0, end_ = 0;  ///< stratified numbers: up to end_
    bool has_key_ = false;
    std::uint64_t key_ = 0;
    glm::vec2 pair_{0};
    std::array<float, 4> block_{};
};

}  // namespace opaline::bake
