#pragma once

#include <cstdint>

#include "formats/opal/check_rows.h"

namespace opaline::formats {

/// Part of an array that records have used so far. Nothing is used twice: what a reader allocates
/// and does for all records together is bounded by the size of the file.
class UsedPart {
  public:
    /// True, and the values first .. first + count - 1 are used, where they lie in an array of
    /// `size` values and at or behind the end of all that were used before. No values lie anywhere
    /// in it.
    bool take(std::uint64_t first, std::uint64_t count, std::uint64_t size) {
        if (!lies_inside(first, count, size)) return false;
        if (count == 0) return true;
        if (first < end_) return false;
        end_ = first + count;
        return true;
    }

  private:
    std::uint64_t end_ = 0;
};

}  // namespace opaline::formats
