#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::formats {

/// Options of the import.
struct ImportOptions {
    double metres_per_unit = 1.0;  ///< length of one file unit [m]; finite and > 0
    /// Folders besides the file's own that may hold its buffers and textures.
    std::vector<std::filesystem::path> allowed_folders = {};
    /// Asked before anything is built that grows with the number of instances; an error of it is
    /// the import's. Empty: any size will do.
    std::function<Status(const SceneCounts&)> check_size = {};
    /// Of primitives without NORMAL: edges of less than this angle are smooth [degrees, 0 to 180].
    double smooth_angle = 0.0;
    /// Meshes that nodes or instances only move are copies of the first (Primitive::copy): far less
    /// memory, for those who know what a copy is. `check_size` then hears of originals alone.
    bool keep_copies = false;
};

/// A scene and everything worth telling the user about it.
struct ImportedScene {
    Scene scene;
    std::vector<Diagnostic> warnings;  ///< what was repaired, and what the baker will not simulate
    std::string media;  ///< the root extension OPALINE_media as text, not yet applied: see
                        ///< parse_media and apply_media of formats/media; empty: none
    std::vector<std::string> notes = {};  ///< about a conforming file, one line each: no warnings
};

/// Reads a glTF 2.0 file, text or binary (told apart by content), with its buffers and the
/// textures that base colours use, into metres and the frame of `Scene::origin`. Untrusted input is
/// safe.
///
/// Primitives stand in the order of the default scene's nodes depth-first, then the mesh's
/// primitives; vertices keep their order. Points and lines keep their running number as an entry
/// without vertices. Where NORMAL is missing, normals are flat or smooth as the options say, and
/// vertices whose faces differ in their normals have copies behind the primitive's last vertex.
/// Meshes stand in their default pose: morph weights and joints at rest.
///
/// Errors: `bad_input` for a file that is missing, damaged, not conforming, without a triangle, or
/// that requires an unsupported extension; `resource` for one past the limits in limits.h or past
/// memory; `usage` for options out of range. Every fault found before stopping is listed.
Result<ImportedScene> import_gltf(const std::filesystem::path& path,
                                  const ImportOptions& options = {});

/// One warning that names the materials that are metals only because the file says nothing of it
/// (Material::is_unstated_metal). For a scene whose media are applied: a medium is no metal.
std::vector<Diagnostic> warn_of_unstated_metals(const Scene& scene);

}  // namespace opaline::formats
