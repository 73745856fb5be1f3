#pragma once

#include <glm/glm.hpp>

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace opaline::bake {

/// A point at which light is gathered, as the ray tracer needs it.
struct Receiver {
    glm::vec3 origin;  ///< [m], where rays start: in front of every triangle that touches the point
    glm::vec3 normal;  ///< unit shading normal; {0,0,0}: no normal exists, nothing is gathered
};

/// A point of a uniformly distributed set on the surface; the areas of a set add up to the surface.
struct SurfaceSample {
    glm::vec3 position;           ///< [m], on the triangle
    glm::vec3 geometric_normal;   ///< unit
    glm::vec3 normal;             ///< unit, interpolated; within the geometric normal's hemisphere
    float area = 0;               ///< [m^2]
    std::uint32_t primitive = 0;  ///< index into Scene::primitives
    Receiver receiver;            ///< rays from here see the terminator of the smooth surface
};

/// A point on the boundary of a body, seen from inside.
struct BodyPoint {
    glm::vec3 position;          ///< [m]
    glm::vec3 normal;            ///< unit, outward; {0,0,0}: nothing is gathered
    glm::vec3 inner;             ///< [m], just inside all triangles that meet at the point
    std::uint32_t material = 0;  ///< whose triangles bound the body
    glm::vec3 aside{0};          ///< [m], along the own face, away from sharp edges (body_points.h)
};

/// The receivers of one part of a scene, as they stand in the file.
struct ReceiverSet {
    enum class Kind : std::uint8_t { vertex, texel, voxel } kind = Kind::vertex;
    std::uint32_t material = 0;     ///< its subject: index into Scene::materials
    std::uint32_t primitive = 0;    ///< vertex: whose vertices, index into Scene::primitives
    std::uint32_t first = 0;        ///< running number of its first receiver
    std::vector<Receiver> outside;  ///< where rays to the light start
    std::vector<BodyPoint> inside;  ///< the same points, seen from inside; no normal where opaque

    std::size_t size() const { return outside.size(); }
};

/// The set that holds a receiver, by its running number. Precondition: there is one.
const ReceiverSet& set_of(std::span<const ReceiverSet> sets, std::uint32_t receiver);
/// Receivers of all sets.
std::uint32_t count_receivers(std::span<const ReceiverSet> sets);

/// Key of a receiver's random numbers where it has no number: a hash of its place and normal, so
/// that copies of a vertex draw the same.
inline std::uint64_t key_of(const Receiver& at) {
    std::uint64_t key = 0x9e3779b97f4a7c15u;
    for (const float value :
         {at.origin.x, at.origin.y, at.origin.z, at.normal.x, at.normal.y, at.normal.z}) {
        key = (key ^ std::bit_cast<std::uint32_t>(value)) * 0xff51afd7ed558ccdu;
        key ^= key >> 32;
    }
    return key;
}

}  // namespace opaline::bake
