#include "bake/trace/touching_triangles.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/triangle.h"
#include "bake/scene/weld.h"
#include "bake/trace/hit_geometry.h"

namespace opaline::bake {
namespace {

// Triangles around a vertex; more belong to no clean mesh, and bound the work of a hostile one.
constexpr std::size_t kMostTriangles = 128;

struct Search {
    const EmbreeScene& triangles;
    const formats::Scene& scene;
    glm::vec3 position;
    float radius;
    std::vector<TouchingTriangle> found;
    bool is_full = false;
};

// Of Embree's point query, for each triangle whose box is near.
bool visit(RTCPointQueryFunctionArguments* arguments) {
    Search& search = *static_cast<Search*>(arguments->userPtr);
    const EmbreeScene::Geometry& own = search.triangles.geometry(geometry_of(*arguments));
    const std::uint32_t number = own.primitive;
    const formats::Primitive& p = search.scene.primitives[number];
    std::array<glm::dvec3, 3> to;
    float extent = 0;
    bool is_corner = false;
    for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 corner =
            p.position[p.index[3 * std::size_t{arguments->primID} + k]] + own.offset;
        to[k] = glm::dvec3(corner) - glm::dvec3(search.position);
        const glm::vec3 way = glm::abs(corner - search.position);
        extent = std::max({extent, way.x, way.y, way.z});
        is_corner = is_corner || weld_key(corner) == weld_key(search.position);
    }
    const glm::vec3 normal = triangle_normal(p, arguments->primID);
    if (normal == glm::vec3(0) || (!is_corner && distance_to_triangle(to[0], to[1], to[2]) >
                                                     static_cast<double>(search.radius))) {
        return false;
    }
    if (search.found.size() == kMostTriangles) {
        search.is_full = true;
        arguments->query->radius = 0;
        return true;  // the query goes on with the smaller radius
    }
    search.found.push_back({number, arguments->primID, is_corner, normal, extent});
    return false;
}

}  // namespace

std::vector<TouchingTriangle> find_touching_triangles(const EmbreeScene& triangles,
                                                      const formats::Scene& scene,
                                                      glm::vec3 position, float radius) {
    Search search{triangles, scene, position, radius, {}};
    if (triangles.triangles() == 0 || !(radius > 0)) return {};
    RTCPointQuery query{position.x, position.y, position.z, 0, radius};
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(triangles.handle(), &query, &context, visit, &search);
    if (search.is_full) return {};
    // Embree's order depends on its hierarchy; that of the sums must not.
    std::ranges::sort(search.found, {},
                      [](const TouchingTriangle& t) { return std::pair(t.primitive, t.triangle); });
    return std::move(search.found);
}

Receiver leave_touching_triangles(const EmbreeScene& triangles, const formats::Scene& scene,
                                  glm::vec3 position, Receiver receiver) {
    // The clearance of the vertex's own triangles bounds the rounding of its coordinates, too.
    const std::vector<TouchingTriangle> found = find_touching_triangles(
        triangles, scene, position, glm::distance(receiver.origin, position));
    if (std::ranges::all_of(found, &TouchingTriangle::is_corner)) return receiver;
    std::vector<glm::vec3> normals;
    std::ranges::transform(found, std::back_inserter(normals), &TouchingTriangle::normal);
    const Clearance clearance = clearest_direction(normals);
    if (!(clearance.cosine > kLeastClearance)) return receiver;
    const float extent = std::ranges::max(found, {}, &TouchingTriangle::extent).extent;
    receiver.origin =
        position + (clearance_bound(position, extent) / clearance.cosine) * clearance.direction;
    return receiver;
}

std::vector<Receiver> leave_touching_triangles(const EmbreeScene& triangles,
                                               const formats::Scene& scene,
                                               std::vector<Receiver> receivers,
                                               const Context& context) {
    std::vector<glm::vec3> position;
    position.reserve(receivers.size());
    for (const formats::Primitive& p : scene.primitives) {
        position.insert(position.end(), p.position.begin(), p.position.end());
    }
    assert(position.size() == receivers.size());
    for_each_block_in_order(
        receivers.size(), 4096, context,
        [&](Range range) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                receivers[i] =
                    leave_touching_triangles(triangles, scene, position[i], receivers[i]);
            }
            return true;
        },
        [](Range, bool) {});
    return receivers;
}

}  // namespace opaline::bake
