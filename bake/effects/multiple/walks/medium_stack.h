#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace opaline::bake {

/// The bodies around a point, the one entered last on top: its medium fills the space. Bodies of
/// one medium that follow one another are counted, so that only changes of medium take room.
class MediumStack {
  public:
    static constexpr std::size_t kCapacity = 12;

    MediumStack(std::uint8_t medium, int bodies) : size_(1) { entry_[0] = {medium, bodies}; }

    bool empty() const { return size_ == 0; }
    /// Precondition: it is not empty.
    std::uint8_t top() const { return entry_[size_ - 1].medium; }

    /// False: there is no room, and nothing changes.
    bool enter(std::uint8_t medium) {
        if (size_ > 0 && top() == medium) {
            ++entry_[size_ - 1].bodies;
            return true;
        }
        if (size_ == kCapacity) return false;
        entry_[size_++] = {medium, 1};
        return true;
    }

    /// Of the bodies of that medium, the one entered last. No effect where there is none: then a
    /// mesh is open or turned inside out.
    void leave(std::uint8_t medium) {
        for (std::size_t i = size_; i-- > 0;) {
            if (entry_[i].medium == medium) {
                if (--entry_[i].bodies == 0) {
                    remove(i);
                }
                return;
            }
        }
    }

  private:
    struct Entry {
        std::uint8_t medium = 0;
        int bodies = 0;
    };

    void remove(std::size_t i) {
        // Its neighbours become one entry where they are of one medium.
        const bool joins = i > 0 && i + 1 < size_ && entry_[i - 1].medium == entry_[i + 1].medium;
        if (joins) {
            entry_[i - 1].bodies += entry_[i + 1].bodies;
        }
        const std::size_t gone = joins ? 2 : 1;
        for (std::size_t j = i; j + gone < size_; ++j) {
            entry_[j] = entry_[j + gone];
        }
        size_ -= gone;
    }

    std::array<Entry, kCapacity> entry_{};
    std::size_t size_ = 0;
};

}  // namespace opaline::bake
