#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "formats/vdb/read_vdb.h"
#include "formats/vdb/reply_format.h"

namespace opaline::formats::vdb {

/// Fills all of `out` with the next bytes; false if there are not so many.
using ByteSource = std::function<bool(std::span<std::byte> out)>;

struct Reply {
    std::vector<VdbGrid> grids;
    std::vector<std::string> unread;  ///< names of grids of the file
    std::optional<Fault> fault;       ///< then there are no grids
};

/// Reads a reply (reply_format.h) as if an attacker had written it: memory grows with the bytes
/// that have come, within limits.h, and grids hold what VdbGrid promises. Nothing if it ends early
/// or breaks a rule.
std::optional<Reply> parse_reply(const ByteSource& source);

}  // namespace opaline::formats::vdb
