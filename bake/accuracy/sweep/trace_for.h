#pragma once

#include <cstdint>
#include <vector>

#include "bake/accuracy/model_truth.h"

namespace opaline::bake {

struct TraceForOptions {
    double seconds = 15;  ///< about; a least amount is traced whatever it takes
    std::uint64_t seed = 0;
    TermSet simulated = ModelCheckOptions().simulated;  ///< light that the bakes hold
    bool lit_by_volumes = false;        ///< they hold light that volumes scatter to surfaces
    bool volumes_see_surfaces = false;  ///< and the part of it that surfaces had sent to these
};

/// Path tracing that the total error of every bake is measured against: few at first, and
/// more as long as the time allows. Once cancelled, what was traced by then. Errors: as
/// trace_model_truth, if that is nothing.
formats::Result<std::vector<LightCheck>> trace_for(const formats::Scene& scene,
                                                   const ModelProbes& probes,
                                                   const TraceForOptions& options,
                                                   const Context& context);

}  // namespace opaline::bake
