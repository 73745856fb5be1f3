#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "formats/scene.h"

namespace opaline::bake {

/// The bodies of one material that have air between them. Triangles that share a point are one
/// part. Parts whose slabs meet in each of thirteen directions are one body, as one may be the
/// hollow of the other, or they may touch. So bodies that are apart may count as one, but what is
/// one body never counts as two. Immutable; any thread may ask.
class SeparateBodies {
  public:
    SeparateBodies() = default;
    SeparateBodies(const formats::Scene& scene, std::uint32_t material);

    /// At least 1, but for a material without triangles.
    std::uint32_t count() const { return count_; }
    /// The body to whose surface a point belongs; of points elsewhere the one with nearest slabs.
    std::uint32_t body_at(const glm::vec3& point) const;

    static constexpr std::size_t kDirections = 13;
    struct Part {
        std::array<float, kDirections> low{}, high{};  ///< along each direction [m]
        std::uint32_t body = 0;
    };

  private:
    void sort_parts();
    void join_parts();

    std::vector<Part> parts_;   // by `low` along axis_
    std::vector<float> reach_;  // largest `high` along it of parts up to each
    std::size_t axis_ = 0;
    float error_ = 0;  // of places along directions, by rounding [m]
    std::uint32_t count_ = 0;
};

}  // namespace opaline::bake
