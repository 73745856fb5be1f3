#include "bake/receivers/smooth_lift.h"

#include <algorithm>

namespace opaline::bake {
namespace {

struct LiftedCorner {
    glm::vec3 position, normal;
    float weight;
};

glm::vec3 mean_lift(const std::array<LiftedCorner, 3>& corners, glm::vec3 point) {
    glm::vec3 lift(0);
    for (const LiftedCorner& c : corners) {
        const float below = std::min(0.0f, glm::dot(point - c.position, c.normal));
        lift -= c.weight * below * c.normal;
    }
    return lift;
}

}  // namespace

glm::vec3 lift_of_vertex(const formats::Primitive& primitive, std::uint32_t vertex) {
    const std::size_t given = primitive.position.size() - primitive.added.size();
    if (vertex < given) return glm::vec3(0);
    const formats::AddedVertex& at = primitive.added[vertex - given];
    const std::array<float, 3> weight = at.weights();
    std::array<LiftedCorner, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = {primitive.position[at.corner[k]], primitive.normal[at.corner[k]], weight[k]};
    }
    return mean_lift(corners, primitive.position[vertex]);
}

glm::vec3 lift_to_smooth_surface(const formats::Primitive& primitive, std::uint32_t first_index,
                                 glm::vec3 barycentric, glm::vec3 position) {
    std::array<LiftedCorner, 3> corners{};
    glm::vec3 lift(0);
    for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t v = primitive.index[first_index + k];
        const glm::vec3 own = lift_of_vertex(primitive, v);
        const float weight = barycentric[static_cast<glm::length_t>(k)];
        corners[k] = {primitive.position[v] + own, primitive.normal[v], weight};
        lift += weight * own;
    }
    return lift + mean_lift(corners, position + lift);
}

}  // namespace opaline::bake
