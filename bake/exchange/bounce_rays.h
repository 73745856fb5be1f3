#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "bake/base/frame.h"
#include "bake/base/rng.h"
#include "bake/exchange/bounce_tree.h"
#include "bake/exchange/scatterers.h"
#include "bake/plan/row_layout.h"
#include "bake/receivers/receiver.h"
#include "bake/trace/packet_lane.h"
#include "bake/trace/ray_scene.h"
#include "formats/scene.h"

namespace opaline::bake {

/// What rays of the exchange meet.
struct BounceSpace {
    const formats::Scene& scene;
    const RayScene& rays;
    /// By material; empty: no opaque or thin-walled surface is glossy.
    std::span<const RowLayout> layouts{};
};

/// Where on a triangle a ray ends.
struct TrianglePlace {
    std::uint32_t primitive = 0, first_index = 0;  ///< into Primitive::index
    float u = 0, v = 0;                            ///< weights of its second and third corner
    /// [m], of a copy from its original, whose scatterers say what it sends: they are where the ray
    /// ends less this.
    glm::vec3 offset{0};
};
inline TrianglePlace triangle_of_hit(const PacketHits& hits, std::size_t lane) {
    return {hits.primitive[lane], hits.first_index[lane], hits.u[lane], hits.v[lane],
            hits.offset[lane]};
}

/// A ray that meets a surface.
struct RayEnd {
    glm::vec3 position{0}, direction{0};  ///< [m]; unit, of the ray
    float distance = 0;                   ///< [m], from its origin
    float error = 0;                      ///< bound [m] on that of the position
    std::uint32_t material = 0;
    SeenSide side;
    TrianglePlace triangle{};
};
/// Of a ray that has met something.
RayEnd end_of_ray(const formats::Scene& scene, const glm::vec3& origin, const glm::vec3& direction,
                  const PacketHits& hits, std::size_t lane);

/// What a surface mirrors of a ray's light, as one direction of its lobe.
struct MirroredRay {
    glm::vec3 origin{0}, direction{0};  ///< [m]; unit
    formats::Rgb share{0, 0, 0};        ///< of the first ray's; 0: nothing is mirrored
    std::uint32_t number = 0;           ///< of the first ray
    /// What the lobe of an opaque or thin-walled surface mirrors of the ray, in its largest band; 0
    /// of a medium's boundary.
    float of_lobe = 0;
    bool is_weak = false;  ///< that lobe: a coat that mirrors little of light along its normal
    std::uint32_t medium = formats::kNone;  ///< material of the medium that it is inside of
    std::uint16_t mirrors = 0, inside = 0;  ///< of its way so far: mirrors; flights inside media

    float largest() const { return std::max({share.r, share.g, share.b}); }
};

/// The boundary of a medium mirrors by the Fresnel reflectance of its angle, about the facet's
/// normal; a rough one about one of the normals that the ray sees, GGX [Heitz2018], drawn by the
/// ray's place and direction. A narrow lobe of another surface (eval_narrow_lobe) mirrors its
/// directional albedo toward the ray, in a direction that sample_narrow_lobe draws.
MirroredRay mirror(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                   std::uint32_t number);

/// The factor by which what a ray meets counts in it with its radiosity: 1 of surfaces (of those
/// with narrow lobes share_beside_lobe). A medium keeps back what its boundary mirrors of the ray,
/// where it sends 1 - F_ext of even light on average: of that its factor and `mirrored` make 1.
float share_of_radiosity(const formats::Material& material, float mirrored);

/// The factor by which the radiosity of a node counts in a ray, of which the lobe there mirrors
/// `mirrored`: (1 - mirrored) / (1 - m), where m is what lobes mirror on average of even light at
/// the node's scatterers. These send out at most 1 - m of it besides, so with `mirrored` it makes 1
/// at most.
float share_beside_lobe(const BounceTree& tree, std::uint32_t node, float mirrored);

/// The one of both that holds for the radiosity of a node where a ray ends; `on`: what mirror() has
/// made of a ray.
float share_of_own(const BounceSpace& space, const BounceTree& tree, std::uint32_t node,
                   const RayEnd& end, const MirroredRay& on, float arriving = 1);

/// The node that answers a mirrored ray: of a surface, of its irradiance, or of the sky.
struct MirroredNode {
    std::uint32_t node = 0;
    formats::Rgb share{0, 0, 0};  ///< of the first ray's light
    std::uint32_t number = 0;
};

/// Follows mirrored rays from mirror to mirror, a few times, and through media that they are inside
/// of (inside_media.h), and appends their hits to `found`. The last medium mirrors nothing; of the
/// last lobe the light is that of its point from all sides, its node of irradiance. Returns the
/// rays traced.
std::uint64_t follow_mirrored(const BounceSpace& space, const BounceTree& tree,
                              std::vector<MirroredRay> open, std::vector<MirroredNode>& found);

/// Rays that `wanted` becomes: the square of a multiple of 4, at least 16.
inline std::uint32_t count_bounce_rays(double wanted) {
    const double side = 4 * std::max(1.0, std::round(0.25 * std::sqrt(wanted)));
    return static_cast<std::uint32_t>(side * side);
}

/// The point of the unit disk of two numbers in [0, 1]: concentric squares become circles.
inline glm::vec2 to_disk(float u, float v) {
    const float a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return glm::vec2(0);
    constexpr float kQuarter = std::numbers::pi_v<float> / 4;
    const bool first = std::abs(a) > std::abs(b);
    const float r = first ? a : b;
    const float angle = first ? kQuarter * (b / a) : 2 * kQuarter - kQuarter * (a / b);
    return {r * std::cos(angle), r * std::sin(angle)};
}

/// One cell of the square from which cosine-distributed directions are drawn.
struct BounceCell {
    glm::vec3 middle{0, 0, 1};      ///< direction of its middle; unit, the normal is z
    glm::vec3 across{0}, along{0};  ///< how far directions change over its two widths: secants
};

/// All cells, row by row, each with a ray.
struct BounceGrid {
    std::uint32_t side = 0;  ///< a multiple of 4
    std::uint32_t rays = 0;  ///< of a point at most: some cells may be cut in four
    std::vector<BounceCell> cells;
    std::vector<BounceCell> quarters;  ///< of all cells, those of a grid of twice the side; or none

    std::uint32_t count() const { return side * side; }
    std::uint32_t most_cut() const { return quarters.empty() ? 0 : (rays - count()) / 3; }
};
/// `count`: of count_bounce_rays.
BounceGrid make_bounce_grid(std::uint32_t count);
/// Fewer cells than that, some two thirds, and quarters of them for the remaining rays. Below 256
/// rays cells are too wide to locate edges, and none is cut.
BounceGrid make_cut_grid(std::uint32_t count);

/// The direction of two numbers in [0, 1], cosine-distributed if these are random: unit, the normal
/// is z.
inline glm::vec3 to_hemisphere(float u, float v) {
    const glm::vec2 d = to_disk(u, v);
    return {d.x, d.y, std::sqrt(std::max(0.0f, 1 - glm::dot(d, d)))};
}

/// What up to sixteen rays of places of their own meet. Each has an `origin` [m] and a `direction`.
template <class Ray>
PacketHits closest_of(const RayScene& scene, std::span<const Ray> rays) {
    RayPacket packet = rays_from({});
    LaneMask lanes{};
    for (std::size_t i = 0; i < rays.size(); ++i) {
        set_origin(packet, i, rays[i].origin);
        set_lane(packet, lanes, i, rays[i].direction);
    }
    return scene.closest(lanes, packet);
}

/// A hit, and the ray and its cell.
struct BounceHit {
    const PacketHits& hits;
    std::size_t lane = 0;
    glm::vec3 origin{0}, direction{0};  ///< [m], unit
    std::size_t cell = 0;               ///< of BounceGrid::cells
};

/// Where in its cell, of row and column, the ray of trace_bounces goes, in [0, 1)^2.
inline glm::vec2 place_in_cell(const BounceGrid& grid, std::uint64_t seed, std::uint64_t key,
                               std::uint32_t row, std::uint32_t column) {
    const std::uint32_t packet = row / 4 * (grid.side / 4) + column / 4;
    const std::uint32_t lane = row % 4 * 4 + column % 4, j = lane % 2;
    const auto u = random_uniform(seed, RandomStage::bounce_rays, key, 8 * packet + lane / 2);
    return {u[2 * j], u[2 * j + 1]};
}

/// Traces a cosine-distributed ray in each cell, in packets of neighbouring cells, and calls
/// visit(hit) for each that hits something, in a fixed order. Cells are in the frame of the normal.
/// Returns the rays. A point without a normal traces none.
template <class Visit>
std::uint64_t trace_bounces(const RayScene& rays, const Receiver& at, const BounceGrid& grid,
                            std::uint64_t seed, Visit&& visit) {
    if (at.normal == glm::vec3(0) || rays.is_empty()) return 0;
    const float width = 1 / static_cast<float>(grid.side);
    const Frame frame = make_frame(at.normal);
    const std::uint64_t key = key_of(at);
    RayPacket packet = rays_from(at.origin);
    LaneMask lanes;
    lanes.fill(-1);
    std::uint32_t number = 0;
    for (std::uint32_t row = 0; row < grid.side; row += 4) {
        for (std::uint32_t column = 0; column < grid.side; column += 4, ++number) {
            for (std::uint32_t i = 0; i < RayPacket::kSize; i += 2) {
                const auto u =
                    random_uniform(seed, RandomStage::bounce_rays, key, 8 * number + i / 2);
                for (std::uint32_t j = 0; j < 2; ++j) {
                    const std::uint32_t lane = i + j;
                    const std::uint32_t across = column + lane % 4, along = row + lane / 4;
                    set_lane(packet, lanes, lane,
                             frame.to_world(to_hemisphere(
                                 (static_cast<float>(across) + u[2 * j]) * width,
                                 (static_cast<float>(along) + u[2 * j + 1]) * width)));
                }
            }
            const PacketHits hits = rays.closest(lanes, packet);
            for (std::size_t lane = 0; lane < RayPacket::kSize; ++lane) {
                if (hits.hit[lane] != 0) {
                    const std::size_t cell = (row + lane / 4) * grid.side + column + lane % 4;
                    visit(BounceHit{hits, lane, at.origin, direction_of(packet, lane), cell});
                }
            }
        }
    }
    return grid.count();
}

}  // namespace opaline::bake
