#include "bake/effects/multiple/walks/find_clearance.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace opaline::bake {
namespace {

struct NearestTriangle {
    const WalkSpace& space;
    glm::vec3 position;
    float square;  // of the distance [m^2]
};

// Squared distance of a triangle from the origin [Ericson2005].
float squared_distance(glm::vec3 a, glm::vec3 b, glm::vec3 c) {
    const glm::vec3 ab = b - a, ac = c - a;
    const float d1 = -glm::dot(ab, a), d2 = -glm::dot(ac, a);
    if (d1 <= 0 && d2 <= 0) {
        return glm::dot(a, a);
    }
    const float d3 = -glm::dot(ab, b), d4 = -glm::dot(ac, b);
    if (d3 >= 0 && d4 <= d3) {
        return glm::dot(b, b);
    }
    const auto square = [](glm::vec3 v) { return glm::dot(v, v); };
    const float vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) {
        return square(a + d1 / (d1 - d3) * ab);
    }
    const float d5 = -glm::dot(ab, c), d6 = -glm::dot(ac, c);
    if (d6 >= 0 && d5 <= d6) {
        return glm::dot(c, c);
    }
    const float vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) {
        return square(a + d2 / (d2 - d6) * ac);
    }
    const float va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        return square(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b));
    }
    const float scale = 1 / (va + vb + vc);
    return square(a + vb * scale * ab + vc * scale * ac);
}

// Of Embree's point query, for each triangle whose box is near.
bool look_at_triangle(RTCPointQueryFunctionArguments* arguments) {
    NearestTriangle& nearest = *static_cast<NearestTriangle*>(arguments->userPtr);
    const WalkSpace& space = nearest.space;
    const formats::Primitive& p =
        space.scene->primitives[space.triangles->geometry(arguments->geomID).primitive];
    const std::uint32_t* const corner = &p.index[3 * std::size_t{arguments->primID}];
    const float square = squared_distance(p.position[corner[0]] - nearest.position,
                                          p.position[corner[1]] - nearest.position,
                                          p.position[corner[2]] - nearest.position);
    if (!(square < nearest.square)) {
        return false;
    }
    nearest.square = square;
    arguments->query->radius = std::sqrt(square);
    return true;
}

}  // namespace

float find_clearance(const WalkSpace& space, glm::vec3 position, float reach) {
    NearestTriangle nearest{space, position, reach * reach};
    RTCPointQuery query{position.x, position.y, position.z, 0, reach};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(space.triangles->handle(), &query, &context, look_at_triangle, &nearest);
    // Of the coordinates, and of a walk's way.
    constexpr float kRounding = 16 * std::numeric_limits<float>::epsilon();
    const glm::vec3 size = glm::abs(position);
    const float distance = std::sqrt(nearest.square);
    return std::max(0.0f,
                    distance * (1 - kRounding) - kRounding * std::max({size.x, size.y, size.z}));
}

}  // namespace opaline::bake
