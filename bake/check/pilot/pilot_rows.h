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

/// The encodings that a pilot may choose from, in order of bytes per row; with fixed coefficients,
/// only 8 and 16 bits.
std::vector<Encoding> list_encodings(const Knobs& knobs);

/// The pairs of all receivers under one encoding, receiver by receiver again: those that were
/// measured and the fixed ones. Precondition: `fixed` has the encoding.
std::vector<CheckedPair> insert_fixed(const PilotScene& pilot,
                                      std::span<const PilotReceiver> receivers,
                                      std::span<const CheckedPair> measured,
                                      const FixedPairs& fixed, const Encoding& encoding);

/// The receivers whose rows depend on trials, or those that do not.
std::vector<PilotReceiver> select_receivers(const PilotScene& pilot,
                                            std::span<const PilotReceiver> receivers,
                                            bool depend_on_trials);

}  // namespace opaline::bake
