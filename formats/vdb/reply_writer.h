#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "formats/vdb/reply_format.h"

namespace opaline::formats::vdb {

/// Writes a reply (reply_format.h) to a pipe. A pipe that cannot be written to has no reader: the
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

}  // namespace opaline::formats::vdb
