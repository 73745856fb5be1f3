/// What the process that reads a file sends to the one that asked. Both are the same program on the
/// same machine, so numbers are sent as they lie in memory. The one that asked trusts none of it.
///
///     u32 kReplyMagic, then records until one of `end` or `fault`; nothing follows that one
///     grid:   u32 tag, text name, GridHead, then its bricks in ascending order of place, each
///             u32 place (index into the table) and 512 values of 1 or 3 floats
///     fault:  u32 tag, three texts
///     end:    u32 tag, u32 number of names (at most kMaxGrids), the names of grids not read
///     text:   u32 number of bytes, bytes
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "formats/vdb/read_vdb.h"

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

/// Writes a reply (reply.h) to a pipe. A pipe that cannot be written to has no reader: the
/// process then ends with exit code 1.
class ReplyWriter {
  public:
    explicit ReplyWriter(int descriptor);

    /// A grid follows: head.bricks calls of write_brick must come next.
    void write_grid(std::string_view name, const GridHead& head);
    /// A brick of the grid at that place of its table: 512 values of 1 or 3 floats, x fastest.
    void write_brick(std::uint32_t place, std::span<const float> values);
    /// The last record of a reply, either of them: sends everything.
    void write_fault(const Fault& fault);
    void write_end(std::span<const std::string> unread = {});

  private:
    void append(std::span<const std::byte> bytes);
    void append_number(std::uint32_t number);
    void append_text(std::string_view text);
    void flush();

    int descriptor_;
    std::vector<std::byte> buffer_;
};

/// Fills all of `out` with the next bytes; false if there are not so many.
using ByteSource = std::function<bool(std::span<std::byte> out)>;

struct Reply {
    std::vector<VdbGrid> grids;
    std::vector<std::string> unread;  ///< names of grids of the file
    std::optional<Fault> fault;       ///< then there are no grids
};

/// Reads a reply (reply.h) as if an attacker had written it: memory grows with the bytes
/// that have come, within limits.h, and grids hold what VdbGrid promises. Nothing if it ends early
/// or breaks a rule.
std::optional<Reply> parse_reply(const ByteSource& source);

}  // namespace opaline::formats::vdb
