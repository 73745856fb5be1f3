#include "bake/specular/bake_openness.h"

#include <limits>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLanes = RayPacket::kSize;

}  // namespace

OpenHemisphere gather_openness(const RayScene& rays, const DirectionSet& directions,
                               const Receiver& receiver) {
    OpenHemisphere seen;
    const glm::vec3 n = receiver.normal;
    if (n == glm::vec3(0)) {
        return seen;
    }
    RayPacket packet = rays_from(receiver.origin - rays.centre());
    double open = 0, all = 0;
    glm::dvec3 axis(0);
    for (const DirectionBlock& block : directions.blocks) {
        if (glm::dot(n, block.axis) < -block.sine_radius) {
            continue;  // wholly below the horizon
        }
        LaneMask lanes;
        RayPacket::Lane cosine;  // integrated over each cell
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            cosine[lane] = n.x * block.moment_x[lane] + n.y * block.moment_y[lane] +
                           n.z * block.moment_z[lane];
            // A cell above the horizon whose ray is not would count the surface itself as a
            // blocker.
            const float ray =
                n.x * block.dir_x[lane] + n.y * block.dir_y[lane] + n.z * block.dir_z[lane];
            lanes[lane] = cosine[lane] > 0.0f && ray > 0.0f ? -1 : 0;
        }
        packet.dir_x = block.dir_x;
        packet.dir_y = block.dir_y;
        packet.dir_z = block.dir_z;
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        if (!rays.is_empty()) {
            rays.occluded(lanes, packet);
        }
        for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
            if (lanes[lane] == 0) {
                continue;
            }
            seen.rays += rays.is_empty() ? 0 : 1;
            const double weight = static_cast<double>(cosine[lane]);
            all += weight;
            if (packet.tfar[lane] > 0.0f) {
                open += weight;
                // The cell's centre rather than its ray, which may lie off it.
                axis +=
                    weight * glm::normalize(glm::dvec3(block.moment_x[lane], block.moment_y[lane],
                                                       block.moment_z[lane]));
            }
        }
    }
    seen.axis = open > 0 ? glm::vec3(glm::normalize(axis)) : n;
    seen.fraction = all > 0 ? static_cast<float>(open / all) : 0.0f;
    return seen;
}

std::vector<formats::Openness> bake_openness(const RayScene& rays, const DirectionSet& directions,
                                             std::span<const Receiver> receivers,
                                             const Context& context, std::uint64_t& traced) {
    struct Block {
        std::vector<formats::Openness> openness;
        std::uint64_t rays = 0;
    };
    constexpr std::size_t kReceiversPerBlock = 256;
    std::vector<formats::Openness> openness;
    openness.reserve(receivers.size());
    for_each_block_in_order(
        receivers.size(), kReceiversPerBlock, context,
        [&](Range range) {
            Block block;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const OpenHemisphere seen = gather_openness(rays, directions, receivers[i]);
                block.openness.push_back(formats::encode_openness(
                    {seen.axis.x, seen.axis.y, seen.axis.z}, seen.fraction));
                block.rays += seen.rays;
            }
            return block;
        },
        [&](Range range, const Block& block) {
            openness.insert(openness.end(), block.openness.begin(), block.openness.end());
            traced += block.rays;
            if (context.on_progress) {
                context.on_progress({"specular", range.end, receivers.size()});
            }
        });
    return openness;
}

}  // namespace opaline::bake
