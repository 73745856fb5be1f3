#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "bake/check/pilot/pilot.h"
#include "bake/effects/rows/gather_rows.h"

namespace opaline::bake {

using PairsOfEncodings = std::vector<std::vector<CheckedPair>>;

/// The rows of pilot receivers under one setting of the knobs, receiver by receiver exactly: no
/// light map, no ray shared.
class PilotRows {
  public:
    /// `receivers`: those whose rows are wanted. `setting` is read again with every measurement;
    /// both must outlive the rows.
    PilotRows(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
              const Knobs& setting);

    /// Prepares an effect of the table anew, for knobs that have changed.
    void prepare(std::size_t effect);

    /// The pairs of all receivers, one set for each encoding; fewer if cancelled.
    PairsOfEncodings measure(std::span<const Encoding> encodings) const;

  private:
    struct SubjectRows {
        SubjectState* subject = nullptr;
        std::vector<BodyPoint> points;  ///< of its receivers
        std::vector<Gatherer> gatherers;
    };
    bool prepare_subject(SubjectRows& rows, std::size_t effect);
    void gather_anew(SubjectRows& rows);

    const PilotScene& pilot_;
    std::span<const PilotReceiver> receivers_;
    const Knobs& setting_;
    Context quiet_;
    std::map<std::uint32_t, SubjectRows> subjects_;  // by material
    std::vector<std::size_t> place_;                 // of each receiver among its subject's
};

}  // namespace opaline::bake
