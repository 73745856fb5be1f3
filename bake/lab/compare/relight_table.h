#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "formats/opal/result.h"
#include "formats/opal/rgb.h"
#include "formats/opal/vec3.h"

namespace opaline::bake {

/// One row of a relight table: the outgoing radiance of a receiver.
struct RelightRow {
    std::uint32_t primitive = 0, vertex = 0;  ///< numbering of formats::Scene
    formats::Rgb radiance;                    ///< [W m^-2 sr^-1], linear Rec. 709
};

/// One row of a table of volumes: what a node scatters.
struct VolumeRow {
    std::uint32_t volume = 0;
    std::array<std::int32_t, 3> voxel{};  ///< of the node
    formats::Rgb radiance;                ///< source radiance [W m^-2 sr^-1]
};

/// Reads a table: a first line starting with `primitive,vertex,r,g,b`, further columns ignored, one
/// row per receiver. Rows keep their order. Untrusted bytes are safe; `name` is for messages.
/// Errors: bad_input naming the line: wrong header, wrong number of fields, malformed, NaN or
/// infinite number.
formats::Result<std::vector<RelightRow>> decode_relight_csv(std::span<const std::byte> bytes,
                                                            const std::string& name);

/// `decode_relight_csv` of a file.
formats::Result<std::vector<RelightRow>> read_relight_csv(const std::filesystem::path& path);

/// Writes `primitive,vertex,r,g,b` and one line per row, numbers with nine significant digits (a
/// float survives the round trip). Errors: resource.
formats::Status write_relight_csv(const std::filesystem::path& path,
                                  std::span<const RelightRow> rows);

/// The same of `volume,i,j,k,r,g,b`. Errors: resource.
formats::Status write_volume_csv(const std::filesystem::path& path,
                                 std::span<const VolumeRow> rows);

/// Writes a point cloud: binary little-endian PLY, float x y z red green blue per receiver.
/// Precondition: one position [m] per row. Errors: resource.
formats::Status write_relight_ply(const std::filesystem::path& path,
                                  std::span<const formats::Vec3> positions,
                                  std::span<const RelightRow> rows);

/// Writes the radiances as an image of 1024 pixels a row, receiver i at pixel (i mod 1024,
/// i / 1024); the rest of the last row is 0. Errors: usage for an empty table, resource.
formats::Status write_relight_exr(const std::filesystem::path& path,
                                  std::span<const RelightRow> rows);

}  // namespace opaline::bake
