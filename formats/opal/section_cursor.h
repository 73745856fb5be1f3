#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "formats/opal/layout.h"

namespace opaline::formats {

/// Hands out arrays of a section one after the other; every size is checked before it is believed.
/// Arrays are spans into the section's bytes, which must be aligned to 16 bytes.
class SectionCursor {
  public:
    explicit SectionCursor(std::span<const std::byte> bytes) : rest_(bytes) {}

    /// The next array with its padding; false, and nothing taken, where the section is too short.
    template <class T>
    bool take(std::uint64_t count, std::span<const T>& out) {
        if (count > rest_.size() / sizeof(T)) {
            return false;
        }
        const std::size_t size = static_cast<std::size_t>(count) * sizeof(T);
        const std::size_t padded = (size + kArrayAlignment - 1) / kArrayAlignment * kArrayAlignment;
        if (padded > rest_.size()) {
            return false;
        }
        out = {reinterpret_cast<const T*>(rest_.data()), static_cast<std::size_t>(count)};
        rest_ = rest_.subspan(padded);
        return true;
    }

    /// A copy of the next value: a head.
    template <class T>
    bool take_one(T& out) {
        std::span<const T> one;
        if (!take(1, one)) {
            return false;
        }
        std::memcpy(&out, one.data(), sizeof out);
        return true;
    }

    bool at_end() const { return rest_.empty(); }

  private:
    std::span<const std::byte> rest_;
};

}  // namespace opaline::formats
