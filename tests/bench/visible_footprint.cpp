#include "tests/bench/visible_footprint.h"

#include <algorithm>
#include <numeric>

namespace opaline::bake {
namespace {

// A node under a footprint and its place in the plane of the footprint.
struct Found {
    NodeWeight node;
    glm::vec3 place;
};

// Keeps what the point sees.
HiddenNodes keep_seen(const RayScene& rays, glm::vec3 from, std::vector<Found>& found) {
    // The plane of a facet lies beside its neighbours: what is that near a node hides nothing.
    constexpr float kNear = 0.98f;
    std::vector<Found> seen;
    for (std::size_t first = 0; first < found.size(); first += RayPacket::kSize) {
        RayPacket packet = rays_from(from);
        LaneMask lanes{};
        const std::size_t count = std::min<std::size_t>(RayPacket::kSize, found.size() - first);
        for (std::size_t lane = 0; lane < count; ++lane) {
            const glm::vec3 way = found[first + lane].place - from;
            const float length = glm::length(way);
            packet.dir_x[lane] = way.x / length;
            packet.dir_y[lane] = way.y / length;
            packet.dir_z[lane] = way.z / length;
            packet.tfar[lane] = kNear * length;
            lanes[lane] = length > 0 ? -1 : 0;
        }
        rays.occluded(lanes, packet);
        for (std::size_t lane = 0; lane < count; ++lane) {
            if (lanes[lane] == 0 || packet.tfar[lane] >= 0) {
                seen.push_back(found[first + lane]);
            }
        }
    }
    const HiddenNodes nodes{found.size(), found.size() - seen.size()};
    found = std::move(seen);
    return nodes;
}

}  // namespace

HiddenNodes weigh_seen_nodes(const formats::Scene& scene, const RayScene& rays,
                             const BounceTree& tree, const Receiver& at, const BounceGrid& grid,
                             std::uint64_t seed, bool only_seen, std::vector<NodeWeight>& weights) {
    weights.clear();
    const float share = 1 / static_cast<float>(grid.count());
    HiddenNodes all;
    std::vector<Found> found;
    std::vector<BounceEnd> ends;
    find_bounce_ends(scene, rays, at, grid, seed, ends);
    for (const BounceEnd& end : ends) {
        if (!end.sends()) {
            continue;
        }
        const SurfaceSide wanted{end.material, end.side.behind, end.side.normal};
        const glm::vec3 y = at.origin + end.distance * end.direction;
        const std::uint32_t next = tree.find(y, wanted, 0);
        if (next == formats::kNone) {
            continue;
        }
        const FootprintKernel kernel =
            footprint_of(at.origin, end, grid.cells[end.cell], make_frame(at.normal));
        const glm::mat3 widths =
            glm::inverse(glm::transpose(glm::mat3(kernel.across, kernel.along, kernel.above)));
        found.clear();
        tree.find_near(kernel, wanted, tree.brightness(next),
                       [&](std::uint32_t node, float weight, glm::vec2 offset) {
                           const glm::vec3 place =
                               kernel.centre + widths * glm::vec3(offset.x, offset.y, 0);
                           found.push_back({{node, weight}, place});
                       });
        if (only_seen) {
            const HiddenNodes nodes = keep_seen(rays, at.origin, found);
            all.looked_at += nodes.looked_at;
            all.hidden += nodes.hidden;
        }
        const float sum =
            std::accumulate(found.begin(), found.end(), 0.0f,
                            [](float so_far, const Found& f) { return so_far + f.node.weight; });
        if (!(sum > 0)) {
            weights.push_back({next, share});
            continue;
        }
        for (const Found& f : found) {
            weights.push_back({f.node.node, share * f.node.weight / sum});
        }
    }
    return all;
}

}  // namespace opaline::bake
