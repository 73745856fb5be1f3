#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/media/media_file.h"

namespace opaline::formats::media {

/// One entry of `clouds`, with the images that it names decoded. `index` counts them.
/// Nothing and errors in the report where the entry is faulty.
std::optional<CloudEntry> read_cloud(const nlohmann::json& entry, std::size_t index,
                                     const std::string& where, gltf::Resources& resources,
                                     gltf::Report& report);

}  // namespace opaline::formats::media
