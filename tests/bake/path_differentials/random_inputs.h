#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>
#include <random>

namespace opaline::tests {

/// Random inputs of an event, the same in every run and with every library.
class RandomInputs {
  public:
    explicit RandomInputs(std::uint64_t seed) : engine(seed) {}

    double uniform(double from = 0, double to = 1) {
        return from + (to - from) * static_cast<double>(engine() >> 11) * 0x1p-53;
    }
    glm::dvec3 vector(double size = 1) {
        return {uniform(-size, size), uniform(-size, size), uniform(-size, size)};
    }
    glm::dvec3 unit() {
        for (;;) {
            const glm::dvec3 v = vector();
            const double length = glm::length(v);
            if (length > 0.1 && length < 1) return v / length;
        }
    }
    /// A unit vector whose dot with `other` is at least `least`.
    glm::dvec3 unit_facing(const glm::dvec3& other, double least) {
        for (;;) {
            const glm::dvec3 v = unit();
            if (glm::dot(v, other) >= least) return v;
        }
    }
    /// A change of a unit vector.
    glm::dvec3 change_of(const glm::dvec3& direction, double size = 1) {
        const glm::dvec3 v = vector(size);
        return v - direction * glm::dot(direction, v);
    }
    std::array<glm::dvec3, 3> triangle() {
        for (;;) {
            const std::array<glm::dvec3, 3> corners{vector(), vector(), vector()};
            if (glm::length(glm::cross(corners[1] - corners[0], corners[2] - corners[0])) > 0.1) {
                return corners;
            }
        }
    }

  private:
    std::mt19937_64 engine;
};

inline constexpr int kRandomCases = 10000;

}  // namespace opaline::tests
