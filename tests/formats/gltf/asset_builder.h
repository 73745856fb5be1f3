#pragma once

#include <gmock/gmock.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "formats/gltf/import_gltf.h"
#include "tests/support/temporary_folder.h"

namespace opaline::tests {

using Json = nlohmann::json;
using Blob = std::vector<std::uint8_t>;

/// Builds small glTF files: `json` is the document but for `buffers`, `bin` its only buffer.
struct AssetBuilder {
    Json json = {{"asset", {{"version", "2.0"}}}};
    Blob bin;

    /// Appends bytes at the next multiple of four; the index of their buffer view.
    std::size_t add_view(const void* data, std::size_t size, std::size_t stride = 0);

    /// Appends values as a tightly packed accessor; its index.
    template <class T>
    std::size_t add(const std::vector<T>& values, const char* type, bool normalized = false) {
        const std::size_t view = add_view(values.data(), values.size() * sizeof(T));
        return add_accessor(view, component_type(T{}), values.size() / components(type), type,
                            normalized);
    }
    std::size_t add_accessor(std::size_t view, unsigned component, std::size_t count,
                             const char* type, bool normalized = false);

    /// A mesh with one primitive of these attributes; further members come from `more`. Its index.
    std::size_t add_mesh(Json attributes, Json more = Json::object());
    /// A node with a mesh; its index. Listed in the scene.
    std::size_t add_node(std::size_t mesh, Json more = Json::object());

    /// The whole file as text with the buffer as a data URI, or as GLB.
    std::string text() const;
    Blob glb() const;
    /// As text beside `buffer.bin`.
    std::string text_with_external_buffer() const;

    static unsigned component_type(float) { return 5126; }
    static unsigned component_type(std::uint32_t) { return 5125; }
    static unsigned component_type(std::uint16_t) { return 5123; }
    static unsigned component_type(std::int16_t) { return 5122; }
    static unsigned component_type(std::uint8_t) { return 5121; }
    static unsigned component_type(std::int8_t) { return 5120; }
    static std::size_t components(const std::string& type);
};

/// A right triangle in the plane z = 0, counter-clockwise seen from +z, at node 0.
AssetBuilder triangle_asset();
/// The same with this material, TEXCOORD_0 of (0, 0), (1, 0), (0, 1), and TEXCOORD_1 `other` times
/// as large.
AssetBuilder textured_triangle(Json material, float other = 1);

/// Something of everything, still small: interleaving aside, every reader is entered.
AssetBuilder rich_asset();

std::string base64(const Blob& bytes);
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);
void write_file(const std::filesystem::path& path, const std::string& text);
void write_file(const std::filesystem::path& path, const Blob& bytes);

/// The triangle in a material with these extensions and a white, dielectric surface.
AssetBuilder asset_with_extensions(Json extensions);
/// Of a medium that scatters: transmission, a volume, scattering.
Json scattering_extensions();

/// Writes the asset as GLB into a fresh folder and imports it.
formats::Result<formats::ImportedScene> import_asset(const AssetBuilder& asset,
                                                     const formats::ImportOptions& options = {});
/// As import_asset, for a file whose text or bytes are given.
formats::Result<formats::ImportedScene> import_text(const std::string& text);
formats::Result<formats::ImportedScene> import_bytes(const Blob& bytes);

/// Imports and expects success; an empty scene where it fails.
formats::ImportedScene must_import(const AssetBuilder& asset,
                                   const formats::ImportOptions& options = {});
/// All diagnostics as lines "where: fault (remedy)"; empty on success.
std::string errors_of(const formats::Result<formats::ImportedScene>& result);
std::string lines(const std::vector<formats::Diagnostic>& diagnostics);

/// A value put at a JSON pointer of an asset (kErased: the member is taken away), and part of the
/// errors that this makes.
struct JsonFault {
    std::string pointer;
    Json value;
    const char* fault;
};
inline const Json kErased = Json(Json::value_t::discarded);
void expect_faults(const AssetBuilder& sound, const std::vector<JsonFault>& faults);

}  // namespace opaline::tests
