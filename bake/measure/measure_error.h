#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/measure/test_lights.h"
#include "bake/receivers/receiver.h"
#include "bake/visibility/ray_scene.h"
#include "formats/opal/sparse_rows.h"

namespace opaline::bake {

/// Numerical error of the finished rows against dense, unquantised transport at twice the cube map
/// resolution, over held-back receivers and the published test lights; relative to the RMS of the
/// reference (design 7).
struct ErrorReport {
    double rms_relative = 0;
    double ci95[2] = {0, 0};  ///< of rms_relative: bootstrap over receivers, 2.5 and 97.5 percent
    double p95_relative = 0, max_relative = 0;
    std::uint32_t receivers_checked = 0;
    std::string reference;  ///< what it was measured against, in words
    struct ByEffect {
        std::string effect;
        double rms_relative = 0;
    };
    std::vector<ByEffect> by_effect;
    std::uint64_t rays = 0;  ///< that the check cost
};

/// Checks grey rows, one per receiver, each holding V max(0, n.w) / pi.
/// Receivers are drawn by (seed, draw), about one in forty and at most 256, so that the check costs
/// at most a tenth of the bake.
ErrorReport measure_direct_error(const RayScene& rays, std::span<const Receiver> receivers,
                                 const formats::SparseRowsView& rows,
                                 std::span<const TestLight> lights, std::uint64_t seed,
                                 const Context& context);

}  // namespace opaline::bake
