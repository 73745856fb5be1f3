#include "bake/refine/receiver_spacing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "bake/trace/irradiance_transport.h"

namespace opaline::bake {
namespace {

constexpr float kFree = std::numeric_limits<float>::infinity();

struct SeenCells {
    std::vector<float> distance;  // of what is seen [m]; kFree: the sky; < 0: below the horizon
    std::vector<float> weight;
};

SeenCells look_around(const RayScene& rays, const DirectionSet& directions,
                      const Receiver& receiver, std::uint64_t& traced) {
    const std::size_t cells = directions.inverse_solid_angle.size();
    SeenCells seen{std::vector(cells, -1.0f), std::vector(cells, 0.0f)};
    RayPacket packet = rays_from(receiver.origin);
    for (const DirectionBlock& block : directions.blocks) {
        if (is_below(block, receiver.normal)) continue;
        LaneMask lanes;
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            const std::uint32_t cell = block.texel[lane];
            const float integral = cosine_integral(block, lane, receiver.normal);
            lanes[lane] = integral > 0 ? -1 : 0;
            if (!(integral > 0)) continue;
            ++traced;
            constexpr float kOpen = 2 * std::numbers::pi_v<float> / 3;
            seen.weight[cell] = integral * integral * directions.inverse_solid_angle[cell] / kOpen;
            seen.distance[cell] = kFree;
        }
        packet.dir_x = block.dir_x;
        packet.dir_y = block.dir_y;
        packet.dir_z = block.dir_z;
        packet.tfar.fill(kFree);
        const PacketHits hits = rays.closest(lanes, packet);
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] != 0 && hits.hit[lane] != 0) {
                seen.distance[block.texel[lane]] = hits.distance[lane];
            }
        }
    }
    return seen;
}

}  // namespace

std::vector<SkyOutline> find_outlines(const RayScene& rays, const DirectionSet& directions,
                                      const Receiver& receiver, std::uint64_t& traced) {
    const SeenCells seen = look_around(rays, directions, receiver, traced);
    const std::uint32_t n = directions.cubemap_size;
    std::vector<SkyOutline> outlines;
    const auto compare = [&](std::uint32_t a, std::uint32_t b) {
        const float near = std::min(seen.distance[a], seen.distance[b]);
        if (near < 0 || near == kFree || std::max(seen.distance[a], seen.distance[b]) < kFree) {
            return;
        }
        // An outline has about as many cells on each side as a line of this slope crosses borders.
        outlines.push_back({0.5f * (seen.weight[a] + seen.weight[b]), near});
    };
    for (std::uint32_t cell = 0; cell < seen.distance.size(); ++cell) {
        if (cell % n + 1 < n) compare(cell, cell + 1);
        if (cell / n % n + 1 < n) compare(cell, cell + n);
    }
    return outlines;
}

float spacing_for(std::span<const SkyOutline> outlines, double angle, double square) {
    const auto error = [&](double length) {
        double sum = 0;
        for (const SkyOutline& outline : outlines) {
            const double s =
                length / (angle * std::max(1e-30, static_cast<double>(outline.distance)));
            sum += static_cast<double>(outline.weight) * std::min(1.0 / 12, s * s * s / 50);
        }
        return sum;
    };
    float nearest = kFree, farthest = 0;
    for (const SkyOutline& outline : outlines) {
        nearest = std::min(nearest, outline.distance);
        farthest = std::max(farthest, outline.distance);
    }
    // The logarithm of the length, between bounds that no outline leaves open.
    double low = std::log(1e-3 * angle * std::max(1e-30, static_cast<double>(nearest)));
    double high = std::log(10 * angle * std::max(1e-30, static_cast<double>(farthest)));
    if (outlines.empty() || error(std::exp(high)) <= square) return kFree;
    for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (error(std::exp(middle)) <= square ? low : high) = middle;
    }
    return static_cast<float>(std::exp(low));
}

}  // namespace opaline::bake
