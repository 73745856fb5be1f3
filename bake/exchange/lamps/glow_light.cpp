#include "bake/exchange/lamps/glow_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "bake/base/frame.h"
#include "bake/exchange/lamps/point_box.h"
#include "bake/exchange/lamps/spread_points.h"
#include "bake/trace/packet_lane.h"

namespace opaline::bake {
namespace {

// Irradiance averages over many steps.
constexpr float kStep = 1;  // voxels

formats::Vec3 to_vec3(const glm::dvec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Sixteen rays from a receiver and their weights.
struct RayBlock {
    RayPacket packet;
    LaneMask lanes{};
    std::array<double, RayPacket::kSize> weight{};
    std::uint32_t count = 0;
};

glm::dvec3 march_block(const GlowLight& glow, const RayScene& surfaces, const Receiver& receiver,
                       RayBlock& block, std::uint64_t& rays) {
    const PacketHits hits =
        surfaces.is_empty() ? PacketHits{} : surfaces.closest(block.lanes, block.packet);
    rays += block.count;
    glm::dvec3 sum(0);
    for (std::uint32_t lane = 0; lane < block.count; ++lane) {
        const bool is_met = !surfaces.is_empty() && hits.hit[lane] != 0;
        sum += block.weight[lane] * glow_radiance(glow, glm::dvec3(receiver.origin),
                                                  glm::dvec3(direction_of(block.packet, lane)),
                                                  is_met ? static_cast<double>(hits.distance[lane])
                                                         : std::numeric_limits<double>::infinity());
    }
    block.lanes = {};
    block.count = 0;
    return sum;
}

}  // namespace

GlowLight make_glow_light(const formats::Scene& scene, std::uint32_t volume,
                          const formats::VolumesView& volumes, std::uint32_t glow,
                          unsigned threads) {
    std::uint32_t emitters = glow + 1;
    for (const formats::GlowRecord& record : volumes.glow.record) {
        emitters = std::max(emitters, record.emitter + 1);
    }
    std::vector<formats::Rgb> color(emitters);
    color[glow] = {1, 1, 1};
    GlowLight result;
    result.light = std::make_unique<runtime::VolumeLight>(runtime::relight_volumes(
        volumes, {},
        {.terms = formats::TermSet::none, .emitters = {.color = color}, .threads = threads}));
    result.lit = runtime::light_volumes(volumes, *result.light);
    // Rays begin in the scene's frame: floats are too coarse for places in a world far from 0.
    for (runtime::LitVolumes::Entry& entry : result.lit.entry) {
        for (std::size_t row = 0; row < 12; row += 4) {
            std::array<double, 12>& m = entry.lattice.to_index;
            m[row + 3] +=
                m[row] * scene.origin.x + m[row + 1] * scene.origin.y + m[row + 2] * scene.origin.z;
        }
    }
    PointBox box;
    const formats::Volume& own = scene.volumes[volume];
    // Voxels of emission are those of density.
    const glm::dmat4 placed = own.density.to_scene * glm::inverse(own.emission.to_scene);
    for (const glm::dvec3& corner : own.emission.corners()) {
        box.include(glm::dvec3(placed * glm::dvec4(corner, 1)));
    }
    result.own = {box.centre(), box.radius()};
    const bool is_scattered =
        std::ranges::any_of(volumes.glow.record, [&](const formats::GlowRecord& record) {
            return record.emitter == glow && record.terms > 0;
        });
    for (const formats::Volume& other : scene.volumes) {
        if (!is_scattered || other.density.empty()) continue;
        for (const glm::dvec3& corner : other.density.corners()) {
            box.include(corner);
        }
    }
    result.all = {box.centre(), box.radius()};
    return result;
}

glm::dvec3 glow_radiance(const GlowLight& glow, const glm::dvec3& from, const glm::dvec3& direction,
                         double reach) {
    runtime::MarchRay ray{to_vec3(from), to_vec3(direction)};
    ray.end = std::min(ray.end, reach);
    const formats::Rgb seen = runtime::march_volumes(glow.lit, ray, {.step = kStep}).radiance;
    return {seen.r, seen.g, seen.b};
}

glm::dvec3 glow_irradiance(const GlowLight& glow, const RayScene& surfaces,
                           const Receiver& receiver, std::uint32_t samples,
                           std::array<float, 2> turn, std::uint64_t& rays) {
    const glm::dvec3 point(receiver.origin), normal(receiver.normal);
    const std::array<BallDirections, 2> ways{BallDirections(glow.own, point, normal),
                                             BallDirections(glow.all, point, normal)};
    const bool is_one = glow.all.radius <= glow.own.radius;
    const std::array<std::uint32_t, 2> count{is_one ? samples : (samples + 1) / 2,
                                             is_one ? 0 : samples / 2};
    RayBlock block{rays_from(receiver.origin)};
    glm::dvec3 sum(0);
    for (std::size_t w = 0; w < ways.size(); ++w) {
        for (std::uint32_t i = 0; i < count[w]; ++i) {
            const glm::dvec2 at = spread_point({turn[0], turn[1]}, i);
            const glm::dvec3 direction = ways[w].sample(at.x, at.y);
            const double cosine = glm::dot(direction, normal);
            const double density =
                count[0] * ways[0].pdf(direction) + count[1] * ways[1].pdf(direction);
            if (!(cosine > 0) || !(density > 0)) continue;
            const std::uint32_t lane = block.count++;
            set_lane(block.packet, block.lanes, lane, glm::vec3(direction));
            block.weight[lane] = cosine / density;
            if (block.count == RayPacket::kSize) {
                sum += march_block(glow, surfaces, receiver, block, rays);
            }
        }
    }
    if (block.count > 0) sum += march_block(glow, surfaces, receiver, block, rays);
    return sum;
}

glm::dvec3 volume_transmittance(const DensitySpace* volumes, const glm::dvec3& from,
                                const glm::dvec3& direction, double reach) {
    if (volumes == nullptr) return glm::dvec3(1);
    const std::array<float, 3> depth =
        optical_depth(*volumes, glm::vec3(from), glm::vec3(direction), static_cast<float>(reach));
    return {std::exp(-static_cast<double>(depth[0])), std::exp(-static_cast<double>(depth[1])),
            std::exp(-static_cast<double>(depth[2]))};
}

BallDirections::BallDirections(const Ball& ball, const glm::dvec3& point, const glm::dvec3& normal)
    : axis_(normal) {
    const glm::dvec3 way = ball.centre - point;
    const double distance = glm::length(way);
    if (!(distance > ball.radius)) return;
    const double sine = ball.radius / distance;
    // 1 - sqrt(1 - sine^2) without cancellation.
    const double cap = sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
    if (!(cap > 0) || cap > 0.5) return;
    axis_ = way / distance;
    cap_ = cap;
}

glm::dvec3 BallDirections::sample(double u, double v) const {
    const double z = cap_ > 0 ? 1 - u * cap_ : std::sqrt(1 - u);
    const double radius = std::sqrt(std::max(0.0, cap_ > 0 ? (1 - z) * (1 + z) : u));
    const double turn = 2 * std::numbers::pi * v;
    const Frame frame = make_frame(glm::vec3(axis_));
    return glm::normalize(radius * std::cos(turn) * glm::dvec3(frame.to_world(glm::vec3(1, 0, 0))) +
                          radius * std::sin(turn) * glm::dvec3(frame.to_world(glm::vec3(0, 1, 0))) +
                          z * axis_);
}

double BallDirections::pdf(const glm::dvec3& direction) const {
    const double cosine = glm::dot(direction, axis_);
    if (!(cap_ > 0)) return std::max(0.0, cosine) * std::numbers::inv_pi;
    return 1 - cosine <= cap_ ? 1 / (2 * std::numbers::pi * cap_) : 0;
}

}  // namespace opaline::bake
