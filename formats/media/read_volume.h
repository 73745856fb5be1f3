#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "formats/gltf/report.h"
#include "formats/gltf/resources.h"
#include "formats/media/media_file.h"

namespace opaline::formats::media {

/// One entry of `volumes`; its file is read, so that it counts as an input, but not understood.
/// Nothing and errors in the report where the entry is faulty.
std::optional<VolumeEntry> read_volume(const nlohmann::json& entry, const std::string& where,
                                       gltf::Resources& resources, gltf::Report& report);

}  // namespace opaline::formats::media
