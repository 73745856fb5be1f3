#include "bake/cli/light_with_layers.h"

#include <chrono>

#include "bake/cli/option_values.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/volume_bounds.h"

namespace opaline::cli {
namespace {

formats::Vec3 centre_of(const formats::AssetView& view) {
    const runtime::BoundingSphere sphere = runtime::bound_asset(view);
    return {static_cast<float>(sphere.x), static_cast<float>(sphere.y),
            static_cast<float>(sphere.z)};
}

}  // namespace

LightWithLayers light_layers_of(const formats::AssetView& view, const OpenedLight& above,
                                double time, unsigned threads) {
    LightWithLayers lit;
    if (view.clouds.empty()) return lit;
    const auto start = std::chrono::steady_clock::now();
    lit.layers = runtime::light_layers(view.clouds, above.environment, above.rotation,
                                       {.time = time, .threads = threads});
    if (!view.primitives.empty() || !view.volumes.empty()) {
        const runtime::LayerScene scene{*lit.layers, above.environment, above.rotation};
        lit.parts = runtime::environments_of_parts(
            scene, view, runtime::volume_corners(view.volumes), centre_of(view), threads);
    }
    lit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return lit;
}

PartVectors project_parts(const LightWithLayers& layers, const OpenedLight& above, std::uint32_t n,
                          unsigned threads) {
    if (!layers.parts) {
        return {{}, {runtime::project_environment(above.environment, n, above.rotation, threads)}};
    }
    PartVectors parts{layers.parts->points, {}};
    for (const formats::Environment& environment : layers.parts->at_point) {
        parts.vector.push_back(runtime::project_environment(environment, n, {}, threads));
    }
    return parts;
}

void add_time_option(CLI::App& command, double& time) {
    command.add_option("--time", time, "move cloud layers by their wind times T [s]")
        ->check(real_number(-1e9, 1e9))
        ->option_text("T [0]");
}

}  // namespace opaline::cli
