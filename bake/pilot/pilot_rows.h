#pragma once

#include <map>
#include <span>
#include <vector>

#include "bake/pilot/pilot.h"

namespace opaline::bake {

/// What changes a receiver's rows before coefficients are chosen.
struct RowSetting {
    double tolerance = 0;
    std::uint32_t depth_samples = 0, single_cubemap = 0;
};

/// Single scattering of the pilot receivers of each medium by rays, in their order.
struct PilotSingle {
    SingleStage stage;
    SingleBatch batch;
    std::vector<std::size_t> place;  ///< of each pilot receiver in the batch
};
using PilotSingles = std::map<std::uint32_t, PilotSingle>;
PilotSingles gather_pilot_single(const PilotScene& pilot, std::span<const PilotReceiver> receivers,
                                 const RowSetting& setting, const Context& context);

/// The pairs of all receivers, one set for each encoding. `single`: of this setting.
std::vector<std::vector<CheckedPair>> measure_rows(
    const PilotScene& pilot, std::span<const PilotReceiver> receivers, const MediaStages& media,
    const PilotSingles& single, const RowSetting& setting, std::uint32_t cubemap_size,
    std::span<const Encoding> encodings, std::span<const TestLight> lights, const Context& context);

}  // namespace opaline::bake
