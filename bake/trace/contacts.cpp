#include "bake/trace/contacts.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <limits>
#include <optional>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/vertex_receivers.h"
#include "bake/scene/triangle.h"
#include "bake/trace/hidden_receivers.h"
#include "bake/trace/touching_triangles.h"

namespace opaline::bake {
namespace {

// The triangles with an area of each vertex of a primitive: v has triangle[begin[v]] and so on.
struct OwnTriangles {
    std::vector<std::uint32_t> begin, triangle;

    std::span<const std::uint32_t> of(std::size_t v) const {
        return std::span(triangle).subspan(begin[v], begin[v + 1] - begin[v]);
    }
};

OwnTriangles collect_own_triangles(const formats::Primitive& p) {
    OwnTriangles own{std::vector<std::uint32_t>(p.position.size() + 1), {}};
    const auto for_each_corner = [&](auto&& visit) {
        for (std::size_t t = 0; t < p.index.size() / 3; ++t) {
            if (triangle_normal(p, t) == glm::vec3(0)) continue;
            for (std::size_t k = 0; k < 3; ++k) {
                visit(p.index[3 * t + k], static_cast<std::uint32_t>(t));
            }
        }
    };
    for_each_corner([&](std::uint32_t v, std::uint32_t) { ++own.begin[v + 1]; });
    for (std::size_t v = 0; v < p.position.size(); ++v) {
        own.begin[v + 1] += own.begin[v];
    }
    own.triangle.resize(own.begin.back());
    std::vector<std::uint32_t> next = own.begin;
    for_each_corner([&](std::uint32_t v, std::uint32_t t) { own.triangle[next[v]++] = t; });
    return own;
}

// A triangle around one of its corners.
struct Corner {
    glm::vec3 at, normal, to_middle;
    float bound;  // [m], what a start needs to be clear of the triangle
    float room;   // [m], from the middle to the nearer edge of those that meet at the corner
};

Corner corner_of(const formats::Primitive& p, std::uint32_t triangle, glm::vec3 at) {
    std::array<glm::vec3, 3> to;
    for (std::size_t k = 0; k < 3; ++k) {
        to[k] = p.position[p.index[3 * std::size_t{triangle} + k]] - at;
    }
    float extent = 0, longest = 0;
    for (const glm::vec3& way : to) {
        const glm::vec3 a = glm::abs(way);
        extent = std::max({extent, a.x, a.y, a.z});
        longest = std::max(longest, glm::length(way));
    }
    const float twice_area = glm::length(glm::cross(to[1] - to[0], to[2] - to[0]));
    return {at, triangle_normal(p, triangle), (to[0] + to[1] + to[2]) / 3.0f,
            clearance_bound(at, extent), longest > 0 ? twice_area / (3 * longest) : 0};
}

// Near the corner, but farther from its edges than rounding reaches.
Contact look_from(const Corner& corner, std::uint32_t vertex) {
    constexpr float kNear = 1.0f / 256, kBounds = 4;
    const float needed = corner.room > 0 ? kBounds * corner.bound / corner.room : 1;
    const float share = std::clamp(needed, kNear, 1.0f);
    return {vertex, corner.at + share * corner.to_middle, corner.bound * corner.normal};
}

std::uint32_t count_backs(const EmbreeScene& triangles, const Contact& contact) {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    std::uint32_t backs = 0;
    const glm::vec3 origin = contact.place + contact.lift;
    for (const glm::vec3& d : probe_directions(glm::normalize(contact.lift))) {
        RTCRayHit ray{};
        ray.ray.org_x = origin.x, ray.ray.org_y = origin.y, ray.ray.org_z = origin.z;
        ray.ray.dir_x = d.x, ray.ray.dir_y = d.y, ray.ray.dir_z = d.z;
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = 0xffffffffu;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(triangles.handle(), &context, &ray);
        const bool is_hit = ray.hit.geomID != RTC_INVALID_GEOMETRY_ID;
        backs += is_hit && ray.hit.Ng_x * d.x + ray.hit.Ng_y * d.y + ray.hit.Ng_z * d.z > 0;
    }
    return backs;
}

std::optional<Contact> find_contact(const EmbreeScene& triangles, const formats::Scene& scene,
                                    const formats::Primitive& p, std::span<const std::uint32_t> own,
                                    glm::vec3 at, std::uint32_t vertex) {
    std::vector<Corner> corners;
    float bound = 0;
    for (const std::uint32_t t : own) {
        corners.push_back(corner_of(p, t, at));
        bound = std::max(bound, corners.back().bound);
    }
    std::vector<glm::vec3> normals;
    std::ranges::transform(find_touching_triangles(triangles, scene, at, bound),
                           std::back_inserter(normals), &TouchingTriangle::normal);
    if (normals.size() <= own.size() || clearest_direction(normals).cosine > kLeastClearance) {
        return {};
    }
    std::optional<Contact> best;
    std::uint32_t fewest = std::numeric_limits<std::uint32_t>::max();
    for (std::size_t i = 0; i < corners.size() && fewest > 0; ++i) {
        const Contact contact = look_from(corners[i], vertex);
        const std::uint32_t backs = corners.size() > 1 ? count_backs(triangles, contact) : 0;
        if (backs < fewest) {
            fewest = backs;
            best = contact;
        }
    }
    return best;
}

}  // namespace

std::vector<Contact> find_contacts(const EmbreeScene& triangles, const formats::Scene& scene,
                                   std::span<const std::uint32_t> vertices,
                                   const Context& context) {
    std::vector<Contact> contacts;
    std::size_t taken = 0;
    std::uint32_t first = 0;
    for (const formats::Primitive& p : scene.primitives) {
        const auto after = static_cast<std::uint32_t>(first + p.position.size());
        const std::size_t begin = taken;
        while (taken < vertices.size() && vertices[taken] < after) {
            ++taken;
        }
        const auto here = vertices.subspan(begin, taken - begin);
        const OwnTriangles own = here.empty() ? OwnTriangles{} : collect_own_triangles(p);
        for_each_block_in_order(
            here.size(), 1024, context,
            [&](Range range) {
                std::vector<Contact> found;
                for (const std::uint32_t vertex :
                     here.subspan(range.begin, range.end - range.begin)) {
                    const std::uint32_t v = vertex - first;
                    if (const auto contact =
                            find_contact(triangles, scene, p, own.of(v), p.position[v], vertex)) {
                        found.push_back(*contact);
                    }
                }
                return found;
            },
            [&](Range, const std::vector<Contact>& found) {
                contacts.insert(contacts.end(), found.begin(), found.end());
            });
        first = after;
    }
    return contacts;
}

void look_beside_contacts(std::span<const Contact> contacts, std::span<Receiver> outside,
                          std::span<BodyPoint> inside) {
    for (const Contact& contact : contacts) {
        outside[contact.vertex].origin = contact.place + contact.lift;
        inside[contact.vertex].position = contact.place;
        inside[contact.vertex].inner = contact.place - contact.lift;
    }
}

}  // namespace opaline::bake
