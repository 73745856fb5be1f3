#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace opaline::bake {

/// The bodies around a point. Where several overlap, the one whose material is the last in their
/// order (scene/nested_media.h) fills the space; a surface of any other is none there. Bodies of
/// one material are counted.
class MediumStack {
  public:
    static constexpr std::size_t kCapacity = 12;  ///< materials

    MediumStack() = default;
    /// `place`: of a material in their order.
    MediumStack(std::uint16_t place, int bodies) : size_(1) { entry_[0] = {place, bodies}; }

    bool empty() const { return size_ == 0; }
    bool is_only(std::uint16_t place) const { return size_ == 1 && entry_[0].place == place; }
    bool contains(std::uint16_t place) const {
        for (std::size_t i = 0; i < size_; ++i) {
            if (entry_[i].place == place) return true;
        }
        return false;
    }
    /// Precondition: it is not empty.
    std::uint16_t top() const { return entry_[size_ - 1].place; }

    /// False: there is no room, and nothing changes.
    bool enter(std::uint16_t place) {
        std::size_t at = size_;
        while (at > 0 && entry_[at - 1].place > place) {
            --at;
        }
        if (at > 0 && entry_[at - 1].place == place) {
            ++entry_[at - 1].bodies;
            return true;
        }
        if (size_ == kCapacity) return false;
        for (std::size_t i = size_++; i > at; --i) {
            entry_[i] = entry_[i - 1];
        }
        entry_[at] = {place, 1};
        return true;
    }

    /// False, and nothing changes, where there is no such body: then a mesh is open or turned
    /// inside out.
    bool leave(std::uint16_t place) {
        for (std::size_t i = 0; i < size_; ++i) {
            if (entry_[i].place != place) continue;
            if (--entry_[i].bodies == 0) {
                for (--size_; i < size_; ++i) {
                    entry_[i] = entry_[i + 1];
                }
            }
            return true;
        }
        return false;
    }

  private:
    struct Entry {
        std::uint16_t place = 0;
        int bodies = 0;
    };

    std::array<Entry, kCapacity> entry_{};  // ascending
    std::size_t size_ = 0;
};

}  // namespace opaline::bake
