#include "bake/check/model_truth.h"

#include <cstddef>
#include <utility>

#include "bake/check/check_model.h"
#include "bake/scene/orient_bodies.h"

namespace opaline::bake {

formats::Result<ModelProbes> choose_model_probes(const formats::Scene& given,
                                                 std::uint32_t receivers, std::uint64_t seed,
                                                 const Context& context) {
    const OrientedBodies bodies = orient_bodies(given);
    const auto scene = make_reference_scene(bodies.scene ? *bodies.scene : given, context.threads);
    if (!scene) return scene.error();
    ModelProbes probes;
    auto lights = make_model_lights(given, probes.left_out);
    if (!lights) return std::move(lights).error();
    probes.lights = std::move(*lights);
    probes.receivers = choose_model_receivers(*scene, receivers, seed);
    return probes;
}

formats::Result<std::vector<LightCheck>> trace_model_truth(const formats::Scene& given,
                                                           const ModelProbes& probes,
                                                           const ModelCheckOptions& options,
                                                           const Context& context) {
    const auto scenes = make_model_scenes(given, context.threads);
    if (!scenes) return scenes.error();
    ModelCheckOptions alike = options;
    alike.noise_share = 0;  // of the files to come nothing is known
    const std::vector<double> black(probes.receivers.size());
    std::vector<LightCheck> truth;
    for (const ModelLight& light : probes.lights) {
        auto traced = check_unmirrored(*scenes, light, probes.receivers, black, alike, context);
        if (!traced) return std::move(traced).error();
        truth.push_back(std::move(*traced));
    }
    return truth;
}

ModelErrorReport compare_with_truth(std::span<const std::vector<double>> luminance,
                                    std::span<const LightCheck> truth, const ModelProbes& probes,
                                    std::uint64_t seed) {
    std::vector<LightCheck> checks(truth.begin(), truth.end());
    for (std::size_t l = 0; l < checks.size(); ++l) {
        for (std::size_t i = 0; i < checks[l].pairs.size(); ++i) {
            ModelPair& pair = checks[l].pairs[i];
            pair.difference = luminance[l][i] - pair.truth;
        }
    }
    ModelErrorReport report = make_model_report(checks, probes.receivers.size(), seed);
    report.left_out = probes.left_out;
    return report;
}

}  // namespace opaline::bake
