#pragma once

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>
#include <string>

#include "formats/vdb/reply.h"

namespace opaline::formats::vdb {

/// What the grids of a reply may still have together; see limits.h.
struct BrickBudget {
    std::uint64_t bricks, table;
};

/// Checks the values of a tree, repairs the few that may be, and writes its bricks to `reply`,
/// after `head` of which the transform is already set. What stands in the way comes back, and then
/// nothing has been written; its `where` is empty.
std::optional<Fault> pack_bricks(const std::string& name, const openvdb::FloatTree& tree,
                                 GridHead head, BrickBudget& budget, ReplyWriter& reply);
std::optional<Fault> pack_bricks(const std::string& name, const openvdb::Vec3STree& tree,
                                 GridHead head, BrickBudget& budget, ReplyWriter& reply);

}  // namespace opaline::formats::vdb
