#include "bake/trace/bake_openness.h"

#include <array>
#include <limits>

#include "bake/base/ordered_parallel.h"
#include "bake/receivers/spatial_order.h"

namespace opaline::bake {
namespace {

struct Sums {
    double open = 0, all = 0;
    glm::dvec3 axis{0};
};

}  // namespace

void gather_openness(const RayScene& rays, const DirectionSet& directions,
                     std::span<const Receiver> receivers, std::span<OpenHemisphere> seen) {
    RayPacket packet{};
    packet.mask.fill(0xffffffffu);
    std::array<Sums, RayPacket::kSize> sums{};
    RayPacket::Lane normal_x{}, normal_y{}, normal_z{};
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        const glm::vec3 origin = receivers[i].origin, n = receivers[i].normal;
        packet.org_x[i] = origin.x, packet.org_y[i] = origin.y, packet.org_z[i] = origin.z;
        normal_x[i] = n.x, normal_y[i] = n.y, normal_z[i] = n.z;
        seen[i] = {n == glm::vec3(0) ? glm::vec3(0, 0, 1) : n, 0, 0};
    }
    for (const DirectionBlock& block : directions.blocks) {
        for (std::uint32_t cell = 0; cell < RayPacket::kSize; ++cell) {
            const glm::vec3 w(block.dir_x[cell], block.dir_y[cell], block.dir_z[cell]);
            const glm::vec3 moment(block.moment_x[cell], block.moment_y[cell],
                                   block.moment_z[cell]);
            LaneMask lanes;
            RayPacket::Lane cosine;  // integrated over the cell
            std::int32_t any = 0;
            for (std::uint32_t i = 0; i < RayPacket::kSize; ++i) {
                cosine[i] =
                    normal_x[i] * moment.x + normal_y[i] * moment.y + normal_z[i] * moment.z;
                // Skip cells whose ray is below the horizon although the cell is above: the surface
                // itself would count as a blocker.
                const float ray = normal_x[i] * w.x + normal_y[i] * w.y + normal_z[i] * w.z;
                lanes[i] = cosine[i] > 0.0f && ray > 0.0f ? -1 : 0;
                any |= lanes[i];
            }
            if (any == 0) continue;
            packet.dir_x.fill(w.x);
            packet.dir_y.fill(w.y);
            packet.dir_z.fill(w.z);
            packet.tfar.fill(std::numeric_limits<float>::infinity());
            if (!rays.is_empty()) {
                rays.occluded(lanes, packet);
            }
            // Use the cell's centre, because its ray may lie elsewhere in the cell.
            const glm::dvec3 centre = glm::normalize(glm::dvec3(moment));
            for (std::size_t i = 0; i < receivers.size(); ++i) {
                const double weight = lanes[i] != 0 ? static_cast<double>(cosine[i]) : 0.0;
                const double open = packet.tfar[i] > 0.0f ? weight : 0.0;
                seen[i].rays += rays.is_empty() ? 0 : static_cast<std::uint64_t>(-lanes[i]);
                sums[i].all += weight;
                sums[i].open += open;
                sums[i].axis += open * centre;
            }
        }
    }
    for (std::size_t i = 0; i < receivers.size(); ++i) {
        if (sums[i].open > 0) {
            seen[i].axis = glm::vec3(glm::normalize(sums[i].axis));
            seen[i].fraction = static_cast<float>(sums[i].open / sums[i].all);
        }
    }
}

std::vector<formats::Openness> bake_openness(const RayScene& rays, const DirectionSet& directions,
                                             std::span<const Receiver> receivers,
                                             const Context& context, std::uint64_t& traced) {
    // Packets hold one direction for many neighbours, whose rays are coherent. The sparse
    // directions of one receiver are not.
    std::vector<glm::vec3> positions;
    for (const Receiver& receiver : receivers) {
        positions.push_back(receiver.origin);
    }
    const std::vector<std::uint32_t> order = spatial_order(positions);
    std::vector<formats::Openness> openness(receivers.size());
    for_each_block_in_order(
        receivers.size(), 16 * RayPacket::kSize, context,
        [&](Range range) {
            std::vector<OpenHemisphere> block(range.end - range.begin);
            std::vector<Receiver> group;
            for (std::size_t first = range.begin; first < range.end; first += group.size()) {
                group.clear();
                while (group.size() < RayPacket::kSize && first + group.size() < range.end) {
                    group.push_back(receivers[order[first + group.size()]]);
                }
                gather_openness(rays, directions, group,
                                std::span(block).subspan(first - range.begin, group.size()));
            }
            return block;
        },
        [&](Range range, const std::vector<OpenHemisphere>& block) {
            for (std::size_t i = range.begin; i < range.end; ++i) {
                const OpenHemisphere& seen = block[i - range.begin];
                openness[order[i]] = formats::encode_openness(
                    {seen.axis.x, seen.axis.y, seen.axis.z}, seen.fraction);
                traced += seen.rays;
            }
            if (context.on_progress) {
                context.on_progress({"openness", range.end, receivers.size()});
            }
        });
    return openness;
}

}  // namespace opaline::bake
