#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "bake/volumes/density_space.h"

namespace opaline::bake {

/// Uniform numbers of estimates of work, in order.
class CostRandom {
  public:
    explicit CostRandom(std::uint64_t sample) : sample_(sample) {}
    /// In [0, 1).
    float operator()();
    /// Unit, uniform over the sphere.
    glm::vec3 direction();

  private:
    std::uint64_t sample_;
    std::uint32_t draw_ = 0;
    std::size_t used_ = 4;
    std::array<float, 4> number_{};
};

struct WalkCount {
    double flights = 0, collisions = 0;
};

/// A walk in green light from a point, as gather_walks follows it, without the light that joins it.
WalkCount count_walk(const DensitySpace& space, glm::vec3 at, CostRandom& random);

}  // namespace opaline::bake
