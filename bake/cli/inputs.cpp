#include "bake/cli/inputs.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string_view>
#include <utility>

#include "bake/cli/messages.h"
#include "bake/environment/builtin_environment.h"
#include "bake/scene/flatten_slabs.h"
#include "formats/media/apply_media.h"
#include "formats/media/read_media.h"

namespace opaline::cli {

using formats::ErrorKind;
using formats::make_error;

namespace {

formats::Status fill_materials(const formats::MediaFile& media, formats::ImportedScene& imported) {
    const auto warnings = formats::apply_media(media, imported.scene);
    if (!warnings) {
        return warnings.error();
    }
    imported.warnings.insert(imported.warnings.end(), warnings->begin(), warnings->end());
    return formats::ok_status();
}

}  // namespace

formats::Result<OpenedAsset> open_asset(const std::filesystem::path& path, formats::Checks checks) {
    auto file = formats::FileBytes::open(path);
    if (!file) {
        return std::move(file).error();
    }
    auto loaded = formats::read_opal(file->bytes(), path.string(), checks);
    if (!loaded) {
        return std::move(loaded).error();
    }
    return OpenedAsset{std::move(*file), std::move(*loaded)};
}

formats::Result<formats::ImportedScene> open_scene(const std::filesystem::path& path,
                                                   const formats::ImportOptions& options,
                                                   const std::filesystem::path& media) {
    if (path.extension() == ".vdb") {
        return make_error(ErrorKind::bad_input, path.string(), "", "volumes are not supported yet",
                          "give a .gltf or .glb file");
    }
    auto imported = formats::import_gltf(path, options);
    if (!imported) {
        return imported;
    }
    // The file on the command line comes last and overrides the scene's media.
    if (!imported->media.empty()) {
        const auto own = formats::parse_media(imported->media, path, "extensions > OPALINE_media");
        if (!own) {
            return own.error();
        }
        if (auto status = fill_materials(*own, *imported); !status) {
            return std::move(status).error();
        }
    }
    if (!media.empty()) {
        const auto file = formats::read_media(media);
        if (!file) {
            return file.error();
        }
        if (auto status = fill_materials(*file, *imported); !status) {
            return std::move(status).error();
        }
    }
    const auto flattened = bake::flatten_slabs(imported->scene, {});
    imported->warnings.insert(imported->warnings.end(), flattened.begin(), flattened.end());
    if (auto status = report_warnings(imported->warnings); !status) {
        return std::move(status).error();
    }
    return imported;
}

formats::Result<OpenedLight> open_light(const std::string& spec, double rotate_degrees) {
    auto opened = bake::open_environment(spec);
    if (!opened) {
        return std::move(opened).error();
    }
    if (auto status = report_warnings(opened->warnings); !status) {
        return std::move(status).error();
    }
    return OpenedLight{
        std::move(opened->environment),
        runtime::rotation_about_y(static_cast<float>(rotate_degrees * std::numbers::pi / 180))};
}

std::string light_help() {
    return "lat-long .exr or .hdr, cube .exr, or a built-in: white, studio, sun:AZ,EL, "
           "sky:TURBIDITY,EL (`opaline example --list` explains them)";
}

formats::Result<formats::Vec3> parse_vec3(const std::string& option, const std::string& text) {
    float value[3] = {};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (int i = 0; i < 3; ++i) {
        const auto [next, error] = std::from_chars(at, end, value[i]);
        const bool last = i == 2;
        if (error != std::errc{} || !std::isfinite(value[i]) ||
            (last ? next != end : next == end || *next != ',')) {
            return make_error(ErrorKind::usage, "", option,
                              "'" + shorten(text) + "' is not a point",
                              "give three numbers: x,y,z");
        }
        at = next + 1;
    }
    return formats::Vec3{value[0], value[1], value[2]};
}

}  // namespace opaline::cli
