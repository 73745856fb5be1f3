#include "bake/transport/irradiance_transport.h"

#include <algorithm>

#include "bake/transport/block_irradiance.h"

namespace opaline::bake {

std::uint64_t gather_irradiance(const RayScene& rays, const DirectionSet& directions,
                                const Receiver& receiver, std::span<float> transport,
                                std::span<const float> transmittance) {
    std::fill(transport.begin(), transport.end(), 0.0f);
    RayPacket packet = rays_from(receiver.origin);
    std::uint64_t traced = 0;
    for (const DirectionBlock& block : directions.blocks) {
        if (!is_below(block, receiver.normal)) {
            traced += trace_block(rays, block, receiver.normal, transmittance, packet, transport);
        }
    }
    divide_by_solid_angle(directions, transport);
    return traced;
}

}  // namespace opaline::bake
