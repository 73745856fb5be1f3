#include "bake/receivers/vertex_receivers.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>

#include "bake/receivers/smooth_lift.h"
#include "bake/scene/triangle.h"
#include "bake/scene/weld.h"

namespace opaline::bake {
namespace {

using formats::Primitive;
using formats::Scene;

// Unit normals of the triangles at each distinct position, as one array cut by offsets.
struct Fans {
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> point;
    std::vector<std::uint32_t> offset;
    std::vector<glm::vec3> normal;
    std::vector<const Primitive*> primitive;  // of each triangle
    std::vector<glm::vec3> corner;            // the two other corners of each triangle
    std::vector<float> extent;  // largest coordinate difference from the point to a corner
};

float largest_coordinate(glm::vec3 p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
}

Fans collect_fans(const Scene& scene) {
    Fans fans;
    const auto for_each_corner = [&](auto&& visit) {
        for (const Primitive& p : scene.primitives) {
            for (std::size_t t = 0; t < p.index.size() / 3; ++t) {
                const glm::vec3 normal = triangle_normal(p, t);
                if (normal == glm::vec3(0)) {
                    continue;  // no area: no ray can hit it
                }
                const glm::vec3 corner[3] = {p.position[p.index[3 * t]],
                                             p.position[p.index[3 * t + 1]],
                                             p.position[p.index[3 * t + 2]]};
                for (std::size_t k = 0; k < 3; ++k) {
                    visit(p, weld_key(corner[k]), normal, corner[(k + 1) % 3], corner[(k + 2) % 3]);
                }
            }
        }
    };
    for_each_corner([&](const Primitive&, glm::vec3 at, glm::vec3, glm::vec3 a, glm::vec3 b) {
        const auto [it, added] =
            fans.point.try_emplace(at, static_cast<std::uint32_t>(fans.point.size()));
        if (added) {
            fans.offset.push_back(0);
            fans.extent.push_back(0);
        }
        ++fans.offset[it->second];
        fans.extent[it->second] = std::max(
            {fans.extent[it->second], largest_coordinate(a - at), largest_coordinate(b - at)});
    });
    fans.offset.push_back(0);
    std::uint32_t sum = 0;
    for (std::uint32_t& entry : fans.offset) {
        sum += std::exchange(entry, sum);
    }
    fans.normal.resize(sum);
    fans.primitive.resize(sum);
    fans.corner.resize(2 * std::size_t{sum});
    std::vector<std::uint32_t> filled(fans.extent.size(), 0);
    for_each_corner(
        [&](const Primitive& p, glm::vec3 at, glm::vec3 normal, glm::vec3 a, glm::vec3 b) {
            const std::uint32_t point = fans.point.find(at)->second;
            const std::size_t slot = fans.offset[point] + filled[point]++;
            fans.normal[slot] = normal;
            fans.primitive[slot] = &p;
            fans.corner[2 * slot] = a;
            fans.corner[2 * slot + 1] = b;
        });
    return fans;
}

// In front of the triangles of one primitive alone.
Clearance clearance_of(const Fans& fans, std::uint32_t point, const Primitive& primitive) {
    std::vector<glm::vec3> own;
    for (std::uint32_t i = fans.offset[point]; i < fans.offset[point + 1]; ++i) {
        if (fans.primitive[i] == &primitive) own.push_back(fans.normal[i]);
    }
    return clearest_direction(own);
}

// Whether triangles of another medium meet there.
bool meets_other_medium(const Scene& scene, const Fans& fans, std::uint32_t point,
                        std::uint32_t material) {
    if (!scene.materials[material].medium) return false;
    const auto begin = fans.primitive.begin() + fans.offset[point];
    const auto end = fans.primitive.begin() + fans.offset[point + 1];
    return std::any_of(begin, end, [&](const Primitive* p) {
        return p->material != material && scene.materials[p->material].medium;
    });
}

// Height of a point's triangles above its tangent plane [m].
float fold_height(const Fans& fans, std::uint32_t point, glm::vec3 position, glm::vec3 normal) {
    float height = 0;
    for (std::size_t i = 2 * std::size_t{fans.offset[point]};
         i < 2 * std::size_t{fans.offset[point + 1]}; ++i) {
        height = std::max(height, glm::dot(fans.corner[i] - position, normal));
    }
    return height;
}

}  // namespace

float intersection_error_bound(float magnitude) {
    // The test subtracts the origin from three vertices, multiplies edges and sums three products:
    // fewer than 16 roundings of numbers up to twice the magnitude, each off by half an ulp.
    constexpr float kRoundings = 32.0f;
    const float bound = kRoundings * std::numeric_limits<float>::epsilon() * magnitude;
    return std::max(bound, std::numeric_limits<float>::min());
}

Receiver moved(const Receiver& receiver, glm::vec3 offset) {
    if (offset == glm::vec3(0)) return receiver;
    // The sum, and the difference when rays run in the frame of the original.
    constexpr float kRoundings = 4 * std::numeric_limits<float>::epsilon();
    const glm::vec3 origin = receiver.origin + offset;
    const glm::vec3 far = glm::max(glm::abs(origin), glm::abs(offset));
    return {origin + kRoundings * std::max({far.x, far.y, far.z}) * receiver.normal,
            receiver.normal};
}

float clearance_bound(glm::vec3 position, float extent) {
    // The test first subtracts the ray's origin from the corners, so its later roundings scale with
    // the extent alone. The origin itself is rounded twice by half an ulp per coordinate, when the
    // point is computed and when it is offset: less than 2 epsilon across any plane.
    constexpr float kRoundings = 4.0f;
    return kRoundings * std::numeric_limits<float>::epsilon() * largest_coordinate(position) +
           intersection_error_bound(extent);
}

Clearance clearest_direction(std::span<const glm::vec3> normals) {
    glm::vec3 d(0);
    for (const glm::vec3& n : normals) {
        d += n;
    }
    Clearance best;
    constexpr int kIterations = 32;
    for (int i = 0; i < kIterations; ++i) {
        const float length = glm::length(d);
        if (!(length > 1e-6f)) break;
        d /= length;
        glm::vec3 worst(0);
        float smallest = 2;
        for (const glm::vec3& n : normals) {
            if (const float cosine = glm::dot(d, n); cosine < smallest) {
                smallest = cosine;
                worst = n;
            }
        }
        if (smallest > best.cosine) {
            best = {d, smallest};
        }
        // Toward the worst normal, by less each time: converges to the centre of the normal cone.
        d += worst * (1.0f / static_cast<float>(i + 2));
    }
    return best;
}

std::vector<Receiver> make_vertex_receivers(const Scene& scene) {
    const Fans fans = collect_fans(scene);
    std::vector<Clearance> clearance(fans.extent.size());
    for (std::size_t i = 0; i < clearance.size(); ++i) {
        clearance[i] = clearest_direction(
            std::span(fans.normal).subspan(fans.offset[i], fans.offset[i + 1] - fans.offset[i]));
    }
    std::vector<Receiver> receivers;
    for (const Primitive& primitive : scene.primitives) {
        for (std::size_t v = 0; v < primitive.position.size(); ++v) {
            const glm::vec3 position = primitive.position[v];
            const glm::vec3 normal = primitive.normal[v];
            const glm::vec3 lift = lift_of_vertex(primitive, static_cast<std::uint32_t>(v));
            Receiver receiver{position + lift, normal};
            if (const auto it = fans.point.find(weld_key(position)); it != fans.point.end()) {
                Clearance c = clearance[it->second];
                if (!(c.cosine > kLeastClearance) &&
                    meets_other_medium(scene, fans, it->second, primitive.material)) {
                    c = clearance_of(fans, it->second, primitive);
                }
                const float bound = clearance_bound(position, fans.extent[it->second]);
                receiver.origin +=
                    c.cosine > kLeastClearance
                        ? (bound / c.cosine) * c.direction
                        : (bound + fold_height(fans, it->second, position, normal)) * normal;
            }
            receivers.push_back(receiver);
        }
    }
    return receivers;
}

}  // namespace opaline::bake
