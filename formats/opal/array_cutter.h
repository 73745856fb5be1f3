#pragma once

#include <cstddef>
#include <span>

namespace opaline::formats {

/// Hands out arrays of some bytes, one after the other.
class ArrayCutter {
  public:
    /// `bytes`: aligned as the first array; the others are of words.
    explicit ArrayCutter(std::span<std::byte> bytes) : rest_(bytes) {}

    /// Precondition: there are as many bytes.
    template <class T>
    std::span<T> take(std::size_t count) {
        static_assert(sizeof(T) % 4 == 0);
        const std::span<T> array(reinterpret_cast<T*>(rest_.data()), count);
        rest_ = rest_.subspan(count * sizeof(T));
        return array;
    }

  private:
    std::span<std::byte> rest_;
};

}  // namespace opaline::formats
