#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <optional>
#include <vector>

#include "bake/cli/inputs.h"
#include "formats/opal/asset.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/part_environments.h"
#include "runtime/part_lights.h"

namespace opaline::cli {

/// A light above an asset's cloud layer, if there is one. Refers to the asset's bytes.
struct LightWithLayers {
    std::optional<runtime::LayerLight> layers;  ///< nothing: the file has no layer
    /// What meshes and volumes see of light and layer; nothing: the light itself, or there are
    /// none.
    std::optional<runtime::PartEnvironments> parts;
    double seconds = 0;  ///< of all

    /// What meshes and volumes mirror, `above` being the light of the sky.
    OpenedLight mirrored(const OpenedLight& above) const {
        return parts ? OpenedLight{parts->mirrored(), {}} : above;
    }
};

/// `time` [s] moves the layer with its wind; `threads` 0: all cores.
LightWithLayers light_layers_of(const formats::AssetView& view, const OpenedLight& above,
                                double time, unsigned threads);

/// Light vectors of the parts of an asset.
struct PartVectors {
    runtime::LightPoints points;
    std::vector<runtime::LightVector> vector;

    runtime::PartLights lights() const { return {vector, points.of_primitive, points.of_volumes}; }
};
/// For a cube map of n x n texels.
PartVectors project_parts(const LightWithLayers& layers, const OpenedLight& above, std::uint32_t n,
                          unsigned threads);

/// The option `--time` of commands that light layers. Valid range: 1e9 s on either side of 0.
void add_time_option(CLI::App& command, double& time);

}  // namespace opaline::cli
