#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/base/rng.h"
#include "bake/reference/net_points.h"

namespace opaline::bake {

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
