#pragma once

#include <cstdint>
#include <string>
#include <type_traits>

/// What the process that reads a file sends to the one that asked. Both are the same program on the
/// same machine, so numbers are sent as they lie in memory. The one that asked trusts none of it.
///
///     u32 kReplyMagic, then records until one of `end` or `fault`; nothing follows that one
///     grid:   u32 tag, text name, GridHead, then its bricks in ascending order of place, each
///             u32 place (index into the table) and 512 values of 1 or 3 floats
///     fault:  u32 tag, three texts
///     end:    u32 tag, u32 number of names (at most kMaxGrids), the names of grids not read
///     text:   u32 number of bytes, bytes
namespace opaline::formats::vdb {

inline constexpr std::uint32_t kReplyMagic = 0x1b56444f;

enum class ReplyTag : std::uint32_t { grid = 1, fault = 2, end = 3 };

struct GridHead {
    std::uint64_t active_voxels = 0, not_a_number = 0, negative = 0;
    double to_scene[16] = {};  ///< columns of the matrix one after another
    std::int32_t first_brick[3] = {}, extent[3] = {};
    std::uint32_t bricks = 0;
    std::uint32_t is_color = 0;  ///< 0 or 1
};
static_assert(std::is_trivially_copyable_v<GridHead> && sizeof(GridHead) == 184);

/// Why a file cannot be used; the parts of a Diagnostic.
struct Fault {
    std::string where, fault, remedy;
    bool is_of_values = false;  ///< a grid that is read, but is no density; not sent
};

}  // namespace opaline::formats::vdb
