#pragma once

#include <array>
#include <cstdint>

#include "bake/base/rng.h"

namespace opaline::bake {

/// The random numbers of one path, a pure function of (seed, pixel, sample), so that a path does
/// not depend on thread or order.
class RandomStream {
  public:
    RandomStream(std::uint64_t seed, std::uint32_t pixel, std::uint32_t sample)
        : seed_(seed), pixel_(pixel), sample_(sample) {}

    /// Uniform in [0, 1), 24 bits.
    float next() {
        if (used_ == 4) {
            block_ = random_uniform(seed_, RandomStage::reference_path,
                                    pixel_ | std::uint64_t{blocks_++} << 32, sample_);
            used_ = 0;
        }
        return block_[used_++];
    }

  private:
    std::uint64_t seed_;
    std::uint32_t pixel_, sample_;
    std::uint32_t blocks_ = 0, used_ = 4;
    std::array<float, 4> block_{};
};

}  // namespace opaline::bake
