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
#include "bake/scene/coverage.h"
#include "bake/trace/hidden_receivers.h"
#include "bake/trace/irradiance_transport.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kLampSamples = 8;  // of each estimate
constexpr double kBrightest = 1e30;  // [lx]: differences and sums of brighter ones would overflow

}  // namespace

float DiffusiveReach::transmittance(float distance) const {
    const auto a = static_cast<double>(absorption), s = static_cast<double>(reduced),
               d = static_cast<double>(distance);
    return static_cast<float>(std::exp(-std::sqrt(3 * a * (a + s)) * d) / (1 + 0.75 * s * d));
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
      directions_{
          make_sparse_direction_set(cubemap_size, 0), make_sparse_direction_set(cubemap_size, 1),
          make_sparse_direction_set(cubemap_size, 2), make_sparse_direction_set(cubemap_size, 3)},
      volumes_(make_density_space(scene)),
      cells_(make_light_cells(cubemap_size)),
      lamps_(lamps) {
    for (const formats::Material& material : scene.materials) {
        reach_.push_back(material.medium ? reach_of(*material.medium) : DiffusiveReach{});
    }
}

ProxyRows ProxyTracer::no_rows() const {
    ProxyRows rows;
    rows.sides = std::ranges::any_of(scene_.materials, is_wall) ? 2 : 1;
    rows.cells = rows.sides * directions_[0].inverse_solid_angle.size();
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
    const bool can_hide = !material.sheet || is_wall(material);
    const bool is_hidden_there = can_hide && is_hidden(rays_, front);
    rows.hidden.push_back(is_hidden_there ? 1 : 0);
    std::array<std::vector<float>, 2> transport;
    transport.fill(std::vector<float>(rows.cells));
    std::vector<float> irradiance(2 * rows.lamps, 0.0f);  // of the estimates
    std::uint64_t traced = 0;
    if (!is_hidden_there) {
        const glm::vec3 behind = 2.0f * sample.position - front.origin;
        const std::vector<float> through = see_through_volumes(sample.position);
        for (std::size_t estimate = 0; estimate < 2; ++estimate) {
            const std::span<float> all = transport[estimate];
            const std::span<float> own = all.first(rows.cells / rows.sides);
            traced += look_outside(front, estimate, own);
            if (material.sheet) {
                traced += look_outside({behind, -front.normal}, estimate,
                                       is_wall(material) ? all.last(own.size()) : own);
            }
            for (std::size_t i = 0; !through.empty() && i < all.size(); ++i) {
                all[i] *= through[i % through.size()];
            }
            if (material.medium) {
                traced += look_inside(reach_[number], {behind, -front.normal}, estimate, own);
            }
        }
        for (std::size_t i = 0; i < lamps_.size(); ++i) {
            for (std::uint32_t estimate = 0; estimate < 2; ++estimate) {
                const auto light_on = [&](const Receiver& side) {
                    return straight_irradiance(rays_, lamps_[i], side, kLampSamples, traced,
                                               &volumes_, estimate * kLampSamples);
                };
                glm::dvec3 light = light_on(front);
                if (material.sheet) light += light_on({behind, -front.normal});
                irradiance[estimate * rows.lamps + std::min(i, rows.lamps - 1)] +=
                    static_cast<float>(std::min(light.x + light.y + light.z, kBrightest));
            }
        }
    }
    for (const std::vector<float>& own : transport) {
        for (const float value : own) {
            rows.cell.push_back(
                static_cast<std::uint8_t>(std::lround(255 * std::clamp(value, 0.0f, 1.0f))));
        }
    }
    rows.lamp.insert(rows.lamp.end(), irradiance.begin(), irradiance.end());
    return traced;
}

// Of light from each cell, the mean over bands; empty without volumes.
std::vector<float> ProxyTracer::see_through_volumes(glm::vec3 position) const {
    if (volumes_.volumes.empty()) return {};
    const std::size_t bands = volumes_.extinction_bands();
    std::vector<float> through(bands * cells_.size());
    gather_transmittance(volumes_, cells_, position, through);
    std::vector<float> mean(cells_.size());
    for (std::size_t i = 0; i < through.size(); ++i) {
        mean[i % mean.size()] += through[i] / static_cast<float>(bands);
    }
    return mean;
}

// Adds the mean of two quarters that lie across.
std::uint64_t ProxyTracer::look_outside(const Receiver& receiver, std::size_t estimate,
                                        std::span<float> transport) const {
    std::uint64_t traced = 0;
    std::vector<float> one(transport.size());
    for (const std::size_t quarter : {estimate, 3 - estimate}) {
        traced += gather_irradiance(rays_, directions_[quarter], receiver, one);
        for (std::size_t i = 0; i < one.size(); ++i) {
            transport[i] += 0.5f * one[i];
        }
    }
    return traced;
}

std::uint64_t ProxyTracer::look_inside(const DiffusiveReach& reach, const Receiver& inner,
                                       std::size_t estimate, std::span<float> transport) const {
    const DirectionSet& directions = directions_[estimate];
    std::vector<float> inside(transport.size(), 0.0f);
    std::uint64_t traced = 0;
    RayPacket packet = rays_from(inner.origin);
    for (const DirectionBlock& block : directions.blocks) {
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
    divide_by_solid_angle(directions, inside);
    std::ranges::transform(transport, inside, transport.begin(), std::plus<>());
    return traced;
}

}  // namespace opaline::bake
