#include "bake/refine/proxy_rows.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/lamps/straight_light.h"
#include "bake/physics/phase_series.h"
#include "bake/receivers/surface_samples.h"
#include "bake/trace/block_irradiance.h"
#include "bake/trace/hidden_receivers.h"
#include "bake/trace/irradiance_transport.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLampSamples = 16;

}  // namespace

float DiffusiveReach::transmittance(float distance) const {
    const float effective = std::sqrt(3 * absorption * (absorption + reduced));
    return std::exp(-effective * distance) / (1 + 0.75f * reduced * distance);
}

DiffusiveReach reach_of(const formats::Medium& medium) {
    const auto rest = static_cast<float>(1 - expand_phase(medium.phase, 2).lambda[1]);
    const formats::Rgb &s = medium.sigma_s, &a = medium.sigma_a;
    DiffusiveReach best{rest * s.r, a.r};
    for (const DiffusiveReach& band :
         {DiffusiveReach{rest * s.g, a.g}, DiffusiveReach{rest * s.b, a.b}}) {
        if (band.reduced + band.absorption < best.reduced + best.absorption) best = band;
    }
    return best;
}

ProxyTracer::ProxyTracer(const formats::Scene& scene, const RayScene& rays,
                         std::uint32_t cubemap_size, std::span<const LampSources> lamps)
    : scene_(scene),
      rays_(rays),
      directions_(make_direction_set(cubemap_size)),
      volumes_(make_density_space(scene)),
      cells_(make_light_cells(cubemap_size)),
      lamps_(lamps) {
    for (const formats::Material& material : scene.materials) {
        reach_.push_back(material.medium ? reach_of(*material.medium) : DiffusiveReach{});
    }
}

ProxyRows ProxyTracer::no_rows() const {
    ProxyRows rows;
    rows.cells = directions_.inverse_solid_angle.size();
    rows.lamps = std::min(lamps_.size(), kMostLamps);
    return rows;
}

std::uint64_t ProxyTracer::append(std::span<const ProxyPoint> points, const Context& context,
                                  ProxyRows& rows) const {
    std::uint64_t traced = 0;
    constexpr std::size_t kBlock = 16;
    for_each_block_in_order(
        points.size(), kBlock, context,
        [&](Range range) {
            std::pair<ProxyRows, std::uint64_t> block{no_rows(), 0};
            for (std::size_t i = range.begin; i < range.end; ++i) {
                block.second += trace(points[i], block.first);
            }
            return block;
        },
        [&](Range, const std::pair<ProxyRows, std::uint64_t>& block) {
            const ProxyRows& part = block.first;
            rows.cell.insert(rows.cell.end(), part.cell.begin(), part.cell.end());
            rows.lamp.insert(rows.lamp.end(), part.lamp.begin(), part.lamp.end());
            rows.hidden.insert(rows.hidden.end(), part.hidden.begin(), part.hidden.end());
            traced += block.second;
        });
    return traced;
}

std::uint64_t ProxyTracer::trace(const ProxyPoint& point, ProxyRows& rows) const {
    const std::uint32_t number = scene_.primitives[point.primitive].material;
    const formats::Material& material = scene_.materials[number];
    const SurfaceSample sample = make_surface_sample(
        scene_, make_surface_point(scene_, {point.primitive, point.first_index}, point.barycentric),
        0);
    const Receiver front = sample.receiver;
    const bool is_hidden_there = !material.sheet && is_hidden(rays_, front);
    rows.hidden.push_back(is_hidden_there ? 1 : 0);
    std::vector<float> transport(rows.cells, 0.0f);
    std::vector<float> irradiance(rows.lamps, 0.0f);
    std::uint64_t traced = 0;
    if (!is_hidden_there) {
        traced += gather_irradiance(rays_, directions_, front, transport);
        const glm::vec3 behind = 2.0f * sample.position - front.origin;
        if (material.sheet) {
            std::vector<float> other(rows.cells);
            traced += gather_irradiance(rays_, directions_, {behind, -front.normal}, other);
            std::ranges::transform(transport, other, transport.begin(), std::plus<>());
        }
        if (!volumes_.volumes.empty()) {
            const std::size_t bands = volumes_.extinction_bands();
            std::vector<float> through(bands * rows.cells);
            gather_transmittance(volumes_, cells_, sample.position, through);
            for (std::size_t i = 0; i < through.size(); ++i) {
                if (i >= rows.cells) through[i % rows.cells] += through[i];
            }
            for (std::size_t i = 0; i < rows.cells; ++i) {
                transport[i] *= through[i] / static_cast<float>(bands);
            }
        }
        if (material.medium) {
            traced += look_inside(reach_[number], {behind, -front.normal}, transport);
        }
        for (std::size_t i = 0; i < lamps_.size(); ++i) {
            const glm::dvec3 light =
                straight_irradiance(rays_, lamps_[i], front, kLampSamples, traced, &volumes_);
            irradiance[std::min(i, rows.lamps - 1)] +=
                static_cast<float>(light.x + light.y + light.z);
        }
    }
    for (const float value : transport) {
        rows.cell.push_back(
            static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))));
    }
    rows.lamp.insert(rows.lamp.end(), irradiance.begin(), irradiance.end());
    return traced;
}

std::uint64_t ProxyTracer::look_inside(const DiffusiveReach& reach, const Receiver& inner,
                                       std::span<float> transport) const {
    std::vector<float> inside(transport.size(), 0.0f);
    std::uint64_t traced = 0;
    RayPacket packet = rays_from(inner.origin);
    for (const DirectionBlock& block : directions_.blocks) {
        if (is_below(block, inner.normal)) continue;
        LaneMask lanes;
        RayPacket::Lane cosine;  // integrated over each cell
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            cosine[lane] = cosine_integral(block, lane, inner.normal);
            lanes[lane] = cosine[lane] > 0 ? -1 : 0;
            traced += lanes[lane] != 0 ? 1 : 0;
        }
        packet.dir_x = block.dir_x;
        packet.dir_y = block.dir_y;
        packet.dir_z = block.dir_z;
        packet.tfar.fill(std::numeric_limits<float>::infinity());
        const PacketHits hits = rays_.closest(lanes, packet);
        for (std::uint32_t lane = 0; lane < RayPacket::kSize; ++lane) {
            if (lanes[lane] != 0 && hits.hit[lane] != 0) {
                inside[block.texel[lane]] +=
                    cosine[lane] * reach.transmittance(hits.distance[lane]);
            }
        }
    }
    divide_by_solid_angle(directions_, inside);
    std::ranges::transform(transport, inside, transport.begin(), std::plus<>());
    return traced;
}

}  // namespace opaline::bake
