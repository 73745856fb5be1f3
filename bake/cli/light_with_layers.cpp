#include "bake/cli/light_with_layers.h"

#include <chrono>

#include "bake/cli/option_values.h"
#include "runtime/clouds/environment_at.h"
#include "runtime/picture/camera.h"

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
        lit.objects =
            OpenedLight{runtime::environment_at(scene, centre_of(view), {.threads = threads}), {}};
    }
    lit.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return lit;
}

void add_time_option(CLI::App& command, double& time) {
    command.add_option("--time", time, "move cloud layers by their wind times T [s]")
        ->check(real_number(-1e9, 1e9))
        ->option_text("T [0]");
}

}  // namespace opaline::cli
