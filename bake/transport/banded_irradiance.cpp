#include "bake/transport/banded_irradiance.h"

#include <algorithm>
#include <limits>

#include "bake/transport/block_irradiance.h"

namespace opaline::bake {
namespace {

float look_up(const std::vector<float>& table, float cosine) {
    const float at = std::clamp(cosine, 0.0f, 1.0f) * static_cast<float>(table.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(at), table.size() - 2);
    return table[i] + (at - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

}  // namespace

std::uint64_t gather_banded_irradiance(const RayScene& rays, const DirectionSet& directions,
                                       const Receiver& receiver,
                                       std::span<const std::vector<float>> factor,
                                       std::span<float> transport) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    const std::size_t texels = directions.inverse_solid_angle.size();
    const glm::vec3 n = receiver.normal;
    RayPacket packet = rays_from(receiver.origin);
    const bool is_open = rays.is_empty();
    std::uint64_t traced = 0;
    for (const DirectionBlock& block : directions.blocks) {
        if (is_below(block, n)) {
            continue;
        }
        LaneMask lanes;
        RayPacket::Lane cosine;  // integrated over each cell
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            cosine[lane] = cosine_integral(block, lane, n);
            lanes[lane] = cosine[lane] > 0.0f ? -1 : 0;
            traced += is_open ? 0 : static_cast<std::uint64_t>(-lanes[lane]);
        }
        packet.dir_x = block.dir_x;
        packet.dir_y = block.dir_y;
        packet.dir_z = block.dir_z;
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        if (!is_open) {
            rays.occluded(lanes, packet);
        }
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] != 0 && packet.tfar[lane] > 0.0f) {
                const float c =
                    glm::dot(n, {block.dir_x[lane], block.dir_y[lane], block.dir_z[lane]});
                for (std::size_t b = 0; b < factor.size(); ++b) {
                    transport[b * texels + block.texel[lane]] +=
                        cosine[lane] * look_up(factor[b], c);
                }
            }
        }
    }
    for (std::size_t b = 0; b < factor.size(); ++b) {
        divide_by_solid_angle(directions, transport.subspan(b * texels, texels));
    }
    return traced;
}

}  // namespace opaline::bake
