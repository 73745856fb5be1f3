#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bake/base/context.h"
#include "bake/check/check_model.h"
#include "bake/reference/path.h"
#include "bake/reference/reference_receivers.h"
#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/result.h"
#include "formats/scene.h"
#include "runtime/emitter_light.h"
#include "runtime/light_vector.h"
#include "runtime/specular.h"

namespace opaline::bake {

/// Whether light is refracted on its way into some medium of the scene.
bool has_refraction(const formats::Scene& scene);

/// A light under which files are compared with path tracing.
struct ModelLight {
    std::string name;
    formats::Environment environment;
};

/// The published lights under which path tracing of the scene converges. Behind a refracting
/// boundary a path hits the sun's disc by chance only: without discs there, and `left_out` names
/// what that changed. Errors: as make_environment.
formats::Result<std::vector<ModelLight>> make_model_lights(const formats::Scene& scene,
                                                           std::vector<std::string>& left_out);

/// One light, as files of one cube map size take it.
struct FileLight {
    const runtime::LightVector& vector;
    const runtime::SpecularLight* mirrored = nullptr;  ///< not null: mirrored light alone
    runtime::EmitterLight emitters = runtime::dark_emitters();
};

/// The file's luminance along the normals, in the order of the receivers.
std::vector<double> relight_receivers(const formats::AssetView& asset,
                                      std::span<const ReferenceReceiver> receivers,
                                      const FileLight& light);

/// One receiver under one light: luminance, and the variance of the true mean.
struct ModelPair {
    double difference = 0, truth = 0, variance = 0;
};

/// Mean squares minus the variance, because the square of a noisy value is too large by it.
struct MeanSquares {
    double difference = 0, truth = 0, variance = 0, mean_difference = 0, mean_truth = 0;
    double count = 0;

    void add(const ModelPair& p);
    double rms_relative() const { return share_of_truth(difference); }
    double noise() const { return share_of_truth(variance); }
    double bias() const { return mean_truth > 0 ? mean_difference / mean_truth : 0; }

  private:
    double share_of_truth(double square) const;
};
MeanSquares sum_up(std::span<const ModelPair> pairs);

/// 95 % interval of rms_relative over `receivers` receivers, > 0. `pairs`: light by light.
std::array<double, 2> model_interval(std::span<const ModelPair> pairs, std::size_t receivers,
                                     std::uint64_t seed);

/// The pairs of one light, one per receiver.
struct LightCheck {
    std::string light;
    std::vector<ModelPair> pairs;
    std::uint32_t samples = 0;      ///< for each
    double missing = 0;             ///< mean luminance of light that files do not simulate
    TermSet terms = TermSet::none;  ///< that were compared
};

/// What files hold of a light, as spaces whose paths are added up. Light that went through volumes
/// is that of the scene as it is; light between surfaces meets volumes that only dim it. All
/// arguments outlive it.
std::vector<PathSpace> held_light_spaces(const ModelScenes& scenes, const LightSampler& sampler,
                                         const ModelCheckOptions& options);

/// Of the paths of space number `space` of those, whose noise must be independent.
std::uint64_t seed_of_space(std::uint64_t seed, std::size_t space);

/// Compares `baked`, luminance by receiver, with path tracing of the terms of `spaces`, added up.
/// Doubles the samples until the noise is low enough or the next round exceeds the limit of work.
/// Errors: interrupted.
formats::Result<LightCheck> check_light(std::span<const PathSpace> spaces,
                                        std::span<const ReferenceReceiver> receivers,
                                        std::span<const double> baked,
                                        const ModelCheckOptions& options, const Context& context);

/// The same for the light that files simulate without mirror reflection, and for missing light:
/// other terms, and light that volumes scatter to surfaces unless the file holds it.
formats::Result<LightCheck> check_unmirrored(const ModelScenes& scenes, const ModelLight& light,
                                             std::span<const ReferenceReceiver> receivers,
                                             std::span<const double> baked,
                                             const ModelCheckOptions& options,
                                             const Context& context);

/// Sums up the checks of all lights at `receivers` receivers; without `left_out`, `mirrored` and
/// `seconds`.
ModelErrorReport make_model_report(std::span<const LightCheck> checks, std::size_t receivers,
                                   std::uint64_t seed);

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
