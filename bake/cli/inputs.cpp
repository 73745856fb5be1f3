#include "bake/cli/inputs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "bake/base/stage_log.h"
#include "bake/cli/messages.h"
#include "bake/cli/option_values.h"
#include "bake/cli/outputs.h"
#include "bake/cli/usage_errors.h"
#include "bake/lights/builtin_environment.h"
#include "bake/scene/flatten_slabs.h"
#include "formats/media/apply_media.h"
#include "formats/media/load_clouds.h"
#include "formats/media/load_volumes.h"
#include "formats/media/read_media.h"
#include "runtime/picture/camera.h"
#include "runtime/volumes/volume_bounds.h"

namespace opaline::cli {
namespace {

using formats::ErrorKind;
using formats::make_error;

formats::Vec3 centre_of(const formats::AssetView& view) {
    const runtime::BoundingSphere sphere = runtime::bound_asset(view);
    return {static_cast<float>(sphere.x), static_cast<float>(sphere.y),
            static_cast<float>(sphere.z)};
}

void join(const std::vector<formats::Diagnostic>& more, formats::ImportedScene& imported) {
    imported.warnings.insert(imported.warnings.end(), more.begin(), more.end());
}

void fill_materials(const formats::MediaFile& media, formats::ImportedScene& imported) {
    join(require(formats::apply_media(media, imported.scene)), imported);
}

void add_clouds(const formats::MediaFile& media, formats::CloudDetail detail,
                formats::ImportedScene& imported) {
    join(require(formats::load_clouds(media, imported.scene, detail)), imported);
}

void add_media(const formats::MediaFile& media, double metres_per_unit, formats::CloudDetail detail,
               formats::ImportedScene& imported) {
    fill_materials(media, imported);
    join(
        require(formats::load_volumes(media, metres_per_unit, imported.scene, {}, &imported.notes)),
        imported);
    add_clouds(media, detail, imported);
}

// A volume alone, with what the media file says of it.
formats::ImportedScene open_vdb(const std::filesystem::path& path,
                                const formats::ImportOptions& options,
                                const std::filesystem::path& media, formats::CloudDetail detail) {
    formats::MediaFile file;
    file.file = path.string();
    if (!media.empty()) file = require(formats::read_media(media, options.allowed_folders));
    auto imported = require(formats::import_vdb(path, file, options.metres_per_unit));
    fill_materials(file, imported);
    add_clouds(file, detail, imported);
    return imported;
}

// The volumes and the cloud layer of a media file, without any surface.
formats::ImportedScene open_media_scene(const std::filesystem::path& path,
                                        const formats::ImportOptions& options,
                                        formats::CloudDetail detail) {
    const auto file = require(formats::read_media(path, options.allowed_folders));
    if (file.volumes.empty() && file.clouds.empty()) {
        refuse(make_error(ErrorKind::bad_input, path.string(), "", "it has no volumes or clouds",
                          "a media file alone is a scene if it places a volume or a cloud layer"));
    }
    formats::ImportedScene imported;
    imported.scene.source = path.string();
    imported.scene.materials.resize(1);
    add_media(file, options.metres_per_unit, detail, imported);
    return imported;
}

formats::ImportedScene open_gltf(const std::filesystem::path& path,
                                 const formats::ImportOptions& options,
                                 const std::filesystem::path& media, formats::CloudDetail detail) {
    auto imported = require(formats::import_gltf(path, options));
    // The file on the command line comes last and overrides the scene's media.
    if (!imported.media.empty()) {
        add_media(require(formats::parse_media(imported.media, path, "extensions > OPALINE_media",
                                               options.allowed_folders)),
                  options.metres_per_unit, detail, imported);
    }
    if (!media.empty()) {
        add_media(require(formats::read_media(media, options.allowed_folders)),
                  options.metres_per_unit, detail, imported);
    }
    join(formats::warn_of_unstated_metals(imported.scene), imported);
    return imported;
}

}  // namespace

formats::Result<OpenedAsset> open_asset(const std::filesystem::path& path, formats::Checks checks) {
    auto file = formats::FileBytes::open(path);
    if (!file) return std::move(file).error();
    auto loaded = formats::read_opal(file->bytes(), path.string(), checks);
    if (!loaded && is_scene_ending(ending_of(path))) {
        const std::string name = path.filename().string();
        return make_error(
            ErrorKind::bad_input, path.string(), "", "is a scene, not an .opal file",
            "bake it first: opaline bake " + name + " -o " + path.stem().string() + ".opal");
    }
    if (!loaded) return std::move(loaded).error();
    return OpenedAsset{std::move(*file), std::move(*loaded)};
}

formats::ImportedScene open_scene(const std::filesystem::path& path,
                                  const formats::ImportOptions& options,
                                  const std::filesystem::path& media, formats::CloudDetail detail) {
    const std::string ending = ending_of(path);
    if (ending == ".opal") {
        refuse(make_error(ErrorKind::bad_input, path.string(), "", "is baked already",
                          "did you mean `opaline render " + path.filename().string() +
                              "`? A bake reads a scene: .gltf, .glb, .vdb or .json"));
    }
    if (ending == ".json" && !media.empty()) {
        refuse(make_error(ErrorKind::usage, media.string(), "--media",
                          "the scene is a media file itself", "join both in one file"));
    }
    auto imported = ending == ".vdb"    ? open_vdb(path, options, media, detail)
                    : ending == ".json" ? open_media_scene(path, options, detail)
                                        : open_gltf(path, options, media, detail);
    join(bake::flatten_slabs(imported.scene), imported);
    require(report_warnings(imported.warnings));
    for (const std::string& note : imported.notes) {
        print_note("opaline: " + printable(path.string()) + ": " + note);
    }
    return imported;
}

void check_light(const std::string& spec) {
    std::error_code ignored;
    if (!bake::is_builtin(spec) && std::filesystem::exists(spec, ignored)) return;
    const auto made = bake::open_environment(spec);  // by its name, or an error
    if (made) return;
    formats::Error error = made.error();
    const std::string nearest = find_nearest(spec, {"white", "black", "studio"});
    if (!nearest.empty() && nearest != spec) {
        std::string& remedy = error.diagnostics.front().remedy;
        remedy = "did you mean '" + nearest + "'? Else " + remedy;
    }
    refuse(std::move(error));
}

OpenedLight open_light(const std::string& spec, double rotate_degrees) {
    check_light(spec);
    auto opened = require(bake::open_environment(spec));
    require(report_warnings(opened.warnings));
    return {std::move(opened.environment),
            runtime::rotation_about_y(static_cast<float>(rotate_degrees * std::numbers::pi / 180))};
}

bool is_scene_ending(std::string_view ending) {
    return ending == ".gltf" || ending == ".glb" || ending == ".vdb" || ending == ".json";
}

std::string light_help() {
    return "lat-long .exr or .hdr, cube .exr, or a built-in: white, black, studio, sun:AZ,EL, "
           "sky:TURBIDITY,EL (`opaline example --list` explains them)";
}

formats::Vec3 parse_vec3(const std::string& option, const std::string& text) {
    float value[3] = {};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(at, end, value[i]);
        const bool last = i == 2;
        if (error != std::errc{} || !std::isfinite(value[i]) ||
            (last ? next != end : next == end || *next != ',')) {
            refuse_usage(option, "'" + shorten(text) + "' is not a point",
                         "give three numbers: x,y,z");
        }
        at = next + 1;
    }
    return formats::Vec3{value[0], value[1], value[2]};
}

LightWithLayers light_layers_of(const formats::AssetView& view, const OpenedLight& above,
                                double time, unsigned threads) {
    LightWithLayers lit;
    if (view.clouds.empty()) return lit;
    const auto start = bake::Clock::now();
    lit.layers = runtime::light_layers(view.clouds, above.environment, above.rotation,
                                       {.time = time, .threads = threads});
    if (has_rows(view)) {
        const runtime::LayerScene scene{*lit.layers, above.environment, above.rotation};
        lit.parts = runtime::environments_of_parts(
            scene, view, runtime::volume_corners(view.volumes), centre_of(view), threads);
    }
    lit.seconds = bake::seconds_since(start);
    return lit;
}

bool has_rows(const formats::AssetView& view) {
    return !view.primitives.empty() || !view.volumes.empty();
}

PartVectors project_parts(const formats::AssetView& view, const LightWithLayers& layers,
                          const OpenedLight& above, unsigned threads) {
    const std::uint32_t n = view.cubemap_size;
    if (!has_rows(view)) return {{}, {runtime::project_environment({}, n, {}, threads)}};
    if (!layers.parts) {
        return {{}, {runtime::project_environment(above.environment, n, above.rotation, threads)}};
    }
    PartVectors parts{layers.parts->points, {}};
    for (const formats::Environment& environment : layers.parts->at_point) {
        parts.vector.push_back(runtime::project_environment(environment, n, {}, threads));
    }
    return parts;
}

void add_time_option(const Command& command, double& time) {
    command.add("--time", "T [0]", real_number(time, -1e9, 1e9),
                "move cloud layers by their wind times T [s]");
}

}  // namespace opaline::cli
