#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bake/check/model_pairs.h"
#include "bake/lab/sweep/reference_ladder.h"
#include "bake/lab/sweep/run_sweep.h"

namespace opaline::bake {

/// Index of the point to compare others of the same choices with: the one with the smallest
/// self-measured error. It need not be the one intended as finest; with little time a preset may
/// have more texels. Ties go to the slowest. Precondition: there is one of these choices.
std::size_t find_finest(std::span<const PointRecord> points, std::string_view choices);

/// Chooses the finest point of each way to choose, and compares the others with it. The truth is
/// that of the choices that most points made. `lights`: names of those that the probes are relit
/// under.
void compare_with_finest(SweepResult& result, const EffectTable& effects,
                         const formats::Scene& scene, std::span<const std::uint32_t> probes,
                         std::span<const std::string> lights);

/// What surfaces' and volumes' bakes are compared with, as far as there was time for it.
struct SweepTruths {
    std::optional<ReferenceLadder> reference;
    std::vector<LightCheck> traced;  ///< that total errors are against
    struct LeftOut {
        std::string name, reason;
    };
    std::vector<LeftOut> left_out;
};

/// `options`: of the path tracing, but for its amount. Each of both takes about `seconds`, and is
/// stopped after half of the `left` seconds that are left by then. A truth that the context stops
/// is left out as well. Errors: resource.
formats::Result<SweepTruths> trace_truths(const formats::Scene& scene, const ModelProbes& probes,
                                          const ModelCheckOptions& options, double seconds,
                                          double left, const Context& context);

}  // namespace opaline::bake
