#include "formats/gltf/import_gltf.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <nlohmann/json.hpp>
#include <utility>

#include "formats/gltf/build_lights.h"
#include "formats/gltf/build_materials.h"
#include "formats/gltf/build_primitives.h"
#include "formats/gltf/check_json.h"
#include "formats/gltf/container.h"
#include "formats/gltf/decode_draco.h"
#include "formats/gltf/decode_meshopt.h"
#include "formats/gltf/find_originals.h"
#include "formats/gltf/parse_document.h"
#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/gltf/validate_document.h"
#include "formats/gltf/walk_scene.h"

namespace opaline::formats {

namespace {

using namespace gltf;

std::string media_text(const nlohmann::json& root) {
    const nlohmann::json* media = find_extension(root, "OPALINE_media");
    return media ? media->dump() : std::string();
}

/// The whole import; every fault is in `report`, and the scene counts only if there is none.
Scene import(const std::filesystem::path& path, const ImportOptions& options, std::string& media,
             Report& report) {
    Scene scene;
    scene.source = path.string();
    auto file = read_whole_file(path, "", report);
    if (!file) return scene;
    Resources resources;
    resources.folder = path.parent_path();
    resources.allowed = options.allowed_folders;
    resources.inputs.push_back(path);
    const Bytes bytes = resources.keep(std::move(*file));
    resources.hash.add(bytes);

    const auto container = split_container(bytes, report);
    auto json = container ? parse_checked_json(container->json, report) : std::nullopt;
    if (!json) return scene;
    check_member_types(*json, report);
    if (report.failed()) return scene;
    media = media_text(*json);
    load_buffers(*json, *container, resources, report);
    if (!report.failed()) {
        decode_meshopt_views(*json, resources, report);
        decode_draco_primitives(*json, resources, report);
    }
    if (report.failed()) return scene;
    const auto document = parse_document(std::move(*json), report);
    if (document) {
        validate_document(*document, resources.buffers, report);
    }
    if (report.failed()) return scene;
    const SceneNodes nodes = walk_scene(*document, resources.buffers, report);
    if (report.failed()) return scene;
    if (options.check_size) {
        if (Status status = options.check_size(
                count_world(*document, options.keep_copies ? originals_of(*document, nodes.meshes)
                                                           : nodes.meshes));
            !status) {
            report.errors = std::move(status).error().diagnostics;
            report.kind = ErrorKind::resource;
            return scene;
        }
    }
    build_materials(*document, nodes.meshes, options.metres_per_unit, resources, scene, report);
    build_primitives(*document, nodes.meshes, resources.buffers,
                     {options.metres_per_unit, options.smooth_angle, options.keep_copies}, scene,
                     report);
    build_lights(*document, nodes.lights, options.metres_per_unit, scene, report);
    const auto is_empty = [](const Primitive& primitive) { return primitive.index.empty(); };
    if (report.failed()) return scene;
    if (std::all_of(scene.primitives.begin(), scene.primitives.end(), is_empty)) {
        report.error("", "the scene has no triangles", "export at least one mesh with faces");
    } else if (std::none_of(scene.primitives.begin(), scene.primitives.end(), has_area)) {
        report.error("", "no triangle of the scene has an area", "check its scale and its faces");
    }
    scene.inputs = std::move(resources.inputs);
    scene.sha256 = resources.hash.finish();
    return scene;
}

}  // namespace

Result<ImportedScene> import_gltf(const std::filesystem::path& path, const ImportOptions& options) {
    Report report;
    report.file = path.string();
    if (!(std::isfinite(options.metres_per_unit) && options.metres_per_unit > 0.0)) {
        return make_error(ErrorKind::usage, report.file, "",
                          "metres per unit is " + std::to_string(options.metres_per_unit),
                          "give a number above 0");
    }
    if (!(options.smooth_angle >= 0.0 && options.smooth_angle <= 180.0)) {
        return make_error(ErrorKind::usage, report.file, "",
                          "the angle of smooth normals is " + std::to_string(options.smooth_angle),
                          "give 0 to 180 degrees");
    }
    try {
        std::string media;
        Scene scene = import(path, options, media, report);
        if (report.failed()) return report.take_error();
        return ImportedScene{std::move(scene), report.take_warnings(), std::move(media),
                             std::move(report.notes)};
    } catch (const std::exception&) {
        // The libraries behind throw on some malformed input that no check of ours names.
        return report.take_exception("split or simplify the scene", kExportAgain);
    }
}

std::vector<Diagnostic> warn_of_unstated_metals(const Scene& scene) {
    constexpr std::size_t kShown = 4;
    std::string names;
    std::size_t count = 0;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const Material& material = scene.materials[i];
        if (!material.is_unstated_metal || material.medium || material.gloss.metallic < 1) continue;
        if (++count <= kShown) {
            names += (names.empty() ? "" : ", ") + label("material", i, material.name);
        }
    }
    if (count == 0) {
        return {};
    }
    return {make_warning(
        scene.source, names + (count > kShown ? " and more" : ""),
        "the file states neither metallicFactor nor roughnessFactor: it is baked as a rough metal, "
        "glTF's default",
        "set metallicFactor to 0 (Blender: use a Principled BSDF), or give a medium by --media")};
}

}  // namespace opaline::formats
