#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "bake/effects/rows/gather_rows.h"

namespace opaline::bake {

/// Batches of several sets of one subject at once: what a batch costs whatever the number of its
/// receivers, such as light maps of all bodies of a medium, is paid once for 200 instances, not 200
/// times. Rows are the same.
class SharedBatches {
  public:
    /// The arguments must outlive it. `bytes`: of all batches that are kept at a time.
    SharedBatches(const BakeInputs& bake, std::span<const SubjectState> subjects,
                  const Knobs& knobs, const Context& context,
                  std::size_t bytes = static_cast<std::size_t>(kBatchBytes));

    /// The gatherers of a set of the bake, with a batch in which its first receiver has a place;
    /// none where the set is too large to share one, or the only one. Sets are asked for in their
    /// order; valid until the next call. `rays` counts up.
    struct Found {
        const std::vector<Gatherer>* gatherers = nullptr;
        std::size_t place = 0;
    };
    Found find(std::size_t set, std::uint64_t& rays);

  private:
    struct Batch {
        std::vector<Gatherer> gatherers;
        std::map<std::size_t, std::size_t> place;  ///< of each set that has not been asked for
    };
    void fill(Batch& batch, std::size_t set, std::uint64_t& rays);

    const BakeInputs& bake_;
    std::span<const SubjectState> subjects_;
    const Knobs& knobs_;
    const Context& context_;
    std::size_t bytes_;                        ///< of one subject
    std::map<std::uint32_t, Batch> batches_;   ///< by material
    std::map<std::uint32_t, Batch> finished_;  ///< of the set asked for last
};

}  // namespace opaline::bake
