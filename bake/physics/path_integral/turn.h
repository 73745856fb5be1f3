#pragma once

#include <array>
#include <cstddef>
#include <glm/glm.hpp>

namespace opaline::bake {

/// A turn in the plane of two directions: the direction at angle phi in [0, angle] is
/// cos(phi) from + sin(phi) aside. It replaces the rotation of [Premoze2003] (9) and (10).
struct Turn {
    glm::dvec3 from{0, 0, 1};  ///< unit
    glm::dvec3 aside{0};       ///< unit, perpendicular to `from`; 0 if `from` and `to` are equal
    glm::dvec3 to{0, 0, 1};    ///< unit
    double angle = 0;          ///< [rad], in [0, pi]
};

/// The shortest turns between two directions: one, or four if the directions are opposite.
class Turns {
  public:
    /// `from` and `to`: unit vectors. Opposite directions span no plane: the four turns lie at
    /// right angles around `from`, and the mean over them stands for that over all planes.
    Turns(glm::dvec3 from, glm::dvec3 to);

    std::size_t size() const { return count_; }
    const Turn& operator[](std::size_t i) const { return turn_[i]; }
    const Turn* begin() const { return turn_.data(); }
    const Turn* end() const { return turn_.data() + count_; }

  private:
    std::array<Turn, 4> turn_;
    std::size_t count_ = 1;
};

}  // namespace opaline::bake
