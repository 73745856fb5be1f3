#include "bake/exchange/lamps/glow_light.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <span>
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

bool has_light(const formats::VolumesView& volumes, std::uint32_t glow) {
    return std::ranges::any_of(volumes.glow.record, [&](const formats::GlowRecord& record) {
        return record.emitter == glow && record.terms > 0;
    });
}

// Volumes lit by one of their lights alone.
GlowLight light_by(const formats::Scene& scene, const formats::VolumesView& volumes,
                   std::uint32_t glow, unsigned threads) {
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
    return result;
}

void include_corners(const std::array<glm::dvec3, 8>& corners, const glm::dmat4& placed,
                     PointBox& box) {
    for (const glm::dvec3& corner : corners) {
        box.include(glm::dvec3(placed * glm::dvec4(corner, 1)));
    }
}

// What leaves a cell of a box along lines across it, to both sides of each axis: light over its
// extent, a mean of its surface.
double light_of_cell(const GlowLight& glow, const glm::dvec3& low, const glm::dvec3& size) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const int u = (axis + 1) % 3, v = (axis + 2) % 3;
        for (int line = 0; line < 8; ++line) {
            glm::dvec3 from = low, direction(0);
            from[u] += (line & 1 ? 0.75 : 0.25) * size[u];
            from[v] += (line & 2 ? 0.75 : 0.25) * size[v];
            direction[axis] = line & 4 ? 1 : -1;
            if (!(line & 4)) from[axis] += size[axis];
            const glm::dvec3 seen = glow_radiance(glow, from, direction, size[axis]);
            sum += (seen.x + seen.y + seen.z) * size[u] * size[v];
        }
    }
    return sum;
}

std::vector<GlowLight::Part> find_parts(const GlowLight& glow, const PointBox& box) {
    constexpr int kSide = 6;
    constexpr std::size_t kMost = 32;
    const glm::dvec3 size = (box.high - box.low) / static_cast<double>(kSide);
    std::vector<GlowLight::Part> parts;
    for (int i = 0; i < kSide * kSide * kSide; ++i) {
        const glm::dvec3 low =
            box.low + size * glm::dvec3(i % kSide, i / kSide % kSide, i / (kSide * kSide));
        const double power = light_of_cell(glow, low, size);
        if (power > 0) parts.push_back({{low + 0.5 * size, 0.5 * glm::length(size)}, power});
    }
    std::ranges::stable_sort(parts, std::greater{}, &GlowLight::Part::power);
    parts.resize(std::min(parts.size(), kMost));
    return parts;
}

/// Directions from a receiver to the parts.
class PartDirections {
  public:
    PartDirections(std::span<const GlowLight::Part> parts, const glm::dvec3& point,
                   const glm::dvec3& normal) {
        double sum = 0;
        for (const GlowLight::Part& part : parts) {
            const glm::dvec3 way = part.ball.centre - point;
            const double radius = part.ball.radius;
            if (glm::dot(way, normal) < -radius) continue;  // below the horizon
            ways_.emplace_back(part.ball, point, normal);
            cumulative_.push_back(sum +=
                                  part.power / std::max(glm::dot(way, way), radius * radius));
        }
        if (!(sum > 0)) ways_.clear();
    }

    bool empty() const { return ways_.empty(); }

    glm::dvec3 sample(double u, double v) const {
        const double at = u * cumulative_.back();
        const std::size_t way = part_of_sum(cumulative_, at);
        const double before = way == 0 ? 0 : cumulative_[way - 1];
        return ways_[way].sample((at - before) / (cumulative_[way] - before), v);
    }

    double pdf(const glm::dvec3& direction) const {
        double sum = 0, before = 0;
        for (std::size_t way = 0; way < ways_.size(); ++way) {
            sum += (cumulative_[way] - before) * ways_[way].pdf(direction);
            before = cumulative_[way];
        }
        return ways_.empty() ? 0 : sum / before;
    }

  private:
    std::vector<BallDirections> ways_;
    std::vector<double> cumulative_;
};

}  // namespace

std::optional<GlowLight> make_glow_light(const formats::Scene& scene, std::uint32_t volume,
                                         const formats::VolumesView& volumes, std::uint32_t glow,
                                         unsigned threads) {
    const bool is_scattered = has_light(volumes, glow);
    if (volume == formats::kNone && !is_scattered) return std::nullopt;
    GlowLight result = light_by(scene, volumes, glow, threads);
    PointBox box;
    if (volume != formats::kNone) {
        const formats::Volume& own = scene.volumes[volume];
        // Voxels of emission are those of density.
        include_corners(own.emission.corners(),
                        own.density.to_scene * glm::inverse(own.emission.to_scene), box);
    }
    for (const formats::Volume& other : scene.volumes) {
        if (!is_scattered || other.density.empty()) continue;
        include_corners(other.density.corners(), glm::dmat4(1), box);
    }
    result.all = {box.centre(), box.radius()};
    result.parts = find_parts(result, box);
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
    const BallDirections all(glow.all, point, normal);
    const PartDirections parts(glow.parts, point, normal);
    const std::uint32_t to_parts = parts.empty() ? 0 : samples - samples / 3;
    RayBlock block{rays_from(receiver.origin)};
    glm::dvec3 sum(0);
    for (std::uint32_t i = 0; i < samples; ++i) {
        const bool is_to_part = i < to_parts;
        const glm::dvec2 at = spread_point({turn[0], turn[1]}, is_to_part ? i : i - to_parts);
        const glm::dvec3 direction = is_to_part ? parts.sample(at.x, at.y) : all.sample(at.x, at.y);
        const double cosine = glm::dot(direction, normal);
        const double density =
            to_parts * parts.pdf(direction) + (samples - to_parts) * all.pdf(direction);
        if (!(cosine > 0) || !(density > 0)) continue;
        const std::uint32_t lane = block.count++;
        set_lane(block.packet, block.lanes, lane, glm::vec3(direction));
        block.weight[lane] = cosine / density;
        if (block.count == RayPacket::kSize) {
            sum += march_block(glow, surfaces, receiver, block, rays);
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
