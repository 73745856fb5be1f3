#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/check/check_model.h"
#include "bake/check/model_pairs.h"

namespace opaline::bake {

/// Where, and under which lights, files of a scene are compared with path tracing.
struct ModelProbes {
    std::vector<ReferenceReceiver> receivers;
    std::vector<ModelLight> lights;
    std::vector<std::string> left_out;
};

/// Errors: resource.
formats::Result<ModelProbes> choose_model_probes(const formats::Scene& scene,
                                                 std::uint32_t receivers, std::uint64_t seed,
                                                 const Context& context);

/// Path tracing at the probes, light by light, for comparison with any number of files: the
/// differences are those of a black file. Traces until the noise of a light is `options.noise` or
/// its events are used up. Errors: resource, interrupted.
formats::Result<std::vector<LightCheck>> trace_model_truth(const formats::Scene& scene,
                                                           const ModelProbes& probes,
                                                           const ModelCheckOptions& options,
                                                           const Context& context);

/// Total error of a file, of model and numbers together: as check_model has it, without
/// `mirrored`. `luminance`: relight_receivers of each light.
ModelErrorReport compare_with_truth(std::span<const std::vector<double>> luminance,
                                    std::span<const LightCheck> truth, const ModelProbes& probes,
                                    std::uint64_t seed);

}  // namespace opaline::bake
