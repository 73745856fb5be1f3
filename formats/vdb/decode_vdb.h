#pragma once

#include <optional>
#include <span>
#include <string>

#include "formats/vdb/reply.h"

namespace opaline::formats::vdb {

/// Reads grids of an OpenVDB file as read_vdb says and writes them to `reply`; what stands in the
/// way comes back. A damaged file may crash the process or make it run out of bounds.
std::optional<Fault> decode_vdb(const std::string& path, std::span<const std::string> names,
                                ReplyWriter& reply);

}  // namespace opaline::formats::vdb
