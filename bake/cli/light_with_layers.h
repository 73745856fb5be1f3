#pragma once

#include <CLI/CLI.hpp>
#include <optional>

#include "bake/cli/inputs.h"
#include "formats/opal/asset.h"
#include "runtime/clouds/layer_light.h"

namespace opaline::cli {

/// A light above an asset's cloud layer, if there is one. Refers to the asset's bytes.
struct LightWithLayers {
    std::optional<runtime::LayerLight> layers;  ///< nothing: the file has no layer
    /// What meshes and volumes see of light and layer (runtime/clouds/environment_at.h), at the
    /// centre of their bounds; nothing: the light itself, or there are none.
    std::optional<OpenedLight> objects;
    double seconds = 0;  ///< of both

    /// The light of meshes and volumes, `above` being that of the sky.
    const OpenedLight& of_objects(const OpenedLight& above) const {
        return objects ? *objects : above;
    }
};

/// `time` [s] moves the layer with its wind; `threads` 0: all cores.
LightWithLayers light_layers_of(const formats::AssetView& view, const OpenedLight& above,
                                double time, unsigned threads);

/// The option `--time` of commands that light layers. Valid range: 1e9 s on either side of 0.
void add_time_option(CLI::App& command, double& time);

}  // namespace opaline::cli
