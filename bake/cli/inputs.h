#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bake/cli/command.h"
#include "formats/gltf/import_gltf.h"
#include "formats/media/load_clouds.h"
#include "formats/opal/asset.h"
#include "formats/opal/environment.h"
#include "formats/opal/file_bytes.h"
#include "formats/opal/read_opal.h"
#include "formats/opal/result.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/part_environments.h"
#include "runtime/light_vector.h"
#include "runtime/part_lights.h"

namespace opaline::cli {

/// The bytes of an `.opal` file and the view into them.
struct OpenedAsset {
    formats::FileBytes file;
    formats::LoadedAsset loaded;
};
formats::Result<OpenedAsset> open_asset(const std::filesystem::path& path,
                                        formats::Checks checks = formats::Checks::structure);

/// Reads a scene, fills its materials with the media of its extension OPALINE_media, then of a
/// media file (none if the path is empty), loads their volumes and cloud layers, flattens
/// sheets of a medium, and reports the warnings (messages.h). A `.vdb` file is a scene of one
/// volume, and a media file (`.json`) one of its volumes and its cloud layer. `detail`: of layers.
/// Throws Refusal.
formats::ImportedScene open_scene(const std::filesystem::path& path,
                                  const formats::ImportOptions& options,
                                  const std::filesystem::path& media, formats::CloudDetail detail);

/// A light as `--light` names it, turned by `--rotate-light` degrees about +Y.
struct OpenedLight {
    formats::Environment environment;
    runtime::Rotation rotation;
};
/// Refuses a name that is neither a built-in nor a file, with the nearest one: before a large file
/// is read. Throws Refusal, as open_light does.
void check_light(const std::string& spec);
/// Reports warnings about repaired pixels.
OpenedLight open_light(const std::string& spec, double rotate_degrees);

/// Whether a file with this ending, in lower case, is read as a scene: ".gltf", ".glb", ".vdb",
/// ".json".
bool is_scene_ending(std::string_view ending);

/// Help text of `--light`.
std::string light_help();

/// "x,y,z"; three finite numbers. Errors: usage, naming the option.
formats::Vec3 parse_vec3(const std::string& option, const std::string& text);

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
/// Whether there is anything but cloud layers, which need no light vector.
bool has_rows(const formats::AssetView& view);
/// Black where no rows are.
PartVectors project_parts(const formats::AssetView& view, const LightWithLayers& layers,
                          const OpenedLight& above, unsigned threads);

/// The option `--time` of commands that light layers. Valid range: 1e9 s on either side of 0.
void add_time_option(const Command& command, double& time);

}  // namespace opaline::cli
