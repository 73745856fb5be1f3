#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <utility>

#include "bake/trace/embree_scene.h"
#include "formats/opal/result.h"
#include "formats/scene.h"

namespace opaline::bake {

/// Sixteen coherent shadow rays, structure of arrays; the layout is Embree's.
struct alignas(64) RayPacket {
    static constexpr std::uint32_t kSize = 16;
    using Lane = std::array<float, kSize>;
    using LaneBits = std::array<std::uint32_t, kSize>;
    Lane org_x, org_y, org_z, tnear;
    Lane dir_x, dir_y, dir_z, time;
    Lane tfar;  ///< in: farthest distance; out: -infinity where something was hit
    LaneBits mask, id, flags;
};

/// Rays from one point; directions and tfar are still to be given.
inline RayPacket rays_from(glm::vec3 origin) {
    RayPacket packet{};
    packet.org_x.fill(origin.x);
    packet.org_y.fill(origin.y);
    packet.org_z.fill(origin.z);
    packet.mask.fill(0xffffffffu);
    return packet;
}

/// Which lanes of a packet to trace: -1 yes, 0 no.
using LaneMask = std::array<std::int32_t, RayPacket::kSize>;

/// The first hit of each ray of a packet. Only lanes with `hit` are defined.
struct PacketHits {
    LaneMask hit;              ///< -1 yes, 0 no
    RayPacket::Lane distance;  ///< along the ray [m]
    RayPacket::Lane cosine;  ///< of the ray with the triangle's normal: > 0 leaves through the back
    RayPacket::Lane error;   ///< bound [m] on the error of the hit's position
    RayPacket::LaneBits material;                  ///< index into Scene::materials
    RayPacket::Lane normal_x, normal_y, normal_z;  ///< unit, of the triangle; 0 without area
    RayPacket::LaneBits primitive, first_index;    ///< of the triangle: Primitive::index; of a copy
                                                   ///< that of its original
    RayPacket::Lane u, v;                          ///< weights of its second and third corner
    std::array<glm::vec3, RayPacket::kSize> offset;  ///< [m], of a copy from there; else 0
};

/// All triangles of a scene, ready for packets of rays in the scene's frame. Immutable once built;
/// any thread may trace.
class RayScene {
  public:
    /// As EmbreeScene::build.
    static formats::Result<RayScene> build(const formats::Scene& scene, unsigned threads);

    /// Any-hit test of the rays in `lanes`, between tnear and tfar. Coherent packets are fast:
    /// about one origin, or about one direction.
    void occluded(const LaneMask& lanes, RayPacket& packet) const;

    /// The nearest hit of the rays in `lanes` beyond tnear, up to tfar. A triangle exactly at tnear
    /// is not hit again.
    PacketHits closest(const LaneMask& lanes, const RayPacket& packet) const;

    /// Which of the rays in `lanes` meet the back of a triangle that hides first (see
    /// EmbreeScene::Geometry): -1 yes, 0 no.
    /// Inside a closed body all do.
    LaneMask meets_back_face(const LaneMask& lanes, const RayPacket& packet) const;

    std::uint64_t triangles() const { return triangles_.triangles(); }
    const EmbreeScene& hierarchy() const { return triangles_; }

    /// True if nothing can be hit, so that no ray need be traced.
    bool is_empty() const { return triangles() == 0; }

  private:
    explicit RayScene(EmbreeScene triangles) : triangles_(std::move(triangles)) {}
    EmbreeScene triangles_;
};

}  // namespace opaline::bake
