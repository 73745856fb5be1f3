#include "bake/lamps/receiver_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "bake/base/frame.h"
#include "bake/base/ordered_parallel.h"
#include "bake/base/rng.h"
#include "bake/lamps/onward_ray.h"
#include "bake/lamps/spread_points.h"
#include "bake/lamps/straight_light.h"
#include "bake/path_differentials/disk_map.h"
#include "bake/scene/texture_footprint.h"
#include "bake/transport/packet_lane.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kReceiversPerBlock = 16;
constexpr std::uint32_t kMostGathered = 16;
constexpr double kLeastGathered = 1e-3;  // of the light that a ray gathers
constexpr double kNear = 0.01;           // of the scene: a receiver's surface is not farther
constexpr std::uint32_t kLeastGlowRays = 16;

bool has_bounces(const LampLight& light) {
    return (light.media != nullptr && !light.media->empty()) ||
           std::ranges::any_of(light.elements,
                               [](const ElementLight& of_lamp) { return !of_lamp.empty(); });
}

// Of N rays spread by the cosine one has pi / (N cosine); cells at the horizon begin there.
double cell_of_ray(float cosine, std::uint32_t rays) {
    const double least = 0.5 / std::sqrt(rays);
    return std::numbers::pi / (rays * std::max(static_cast<double>(cosine), least));
}

/// A ray of a receiver.
struct GatherRay {
    glm::dvec3 from, direction;
    std::uint64_t key;
    std::uint32_t number;
};

// Adds what the surfaces along a ray send toward it that begins at `at`, the first of them: metals
// and media pass on what is beyond. `view`: of the first surface's textures; others are points'.
void gather_along(const LampLight& light, GatherRay ray, Arrival at, const TextureView* view,
                  std::vector<glm::dvec3>& sum, std::uint64_t& rays) {
    glm::dvec3 weight = volume_transmittance(light.volumes, ray.from, ray.direction, at.distance);
    PathDifferential unused;
    for (std::uint32_t flight = 0; flight < kMostGathered; ++flight) {
        add_reflected(light, at, weight, flight == 0 ? view : nullptr, sum);
        const bool is_medium = lets_through(light.scene, at);
        if (!is_medium && mirror_chance(light.scene, at, ray.direction) == 0) return;
        const auto x = random_uniform(light.seed, RandomStage::gather_rays, ray.key,
                                      1 + ray.number * kMostGathered + flight);
        unused.count = 0;
        const auto onward =
            is_medium
                ? cross_boundary(light.scene, at, ray.direction, first_three(x), {}, unused)
                : mirror_ray(light.scene, at, ray.direction,
                             {static_cast<double>(x[0]), static_cast<double>(x[1])}, {}, unused);
        if (!onward) return;
        ray.from = leave_surface(ray.from, ray.direction, at, onward->crosses);
        ray.direction = onward->direction;
        ++rays;
        const auto next = find_arrival(light.rays, glm::vec3(ray.from), glm::vec3(ray.direction));
        if (!next) return;
        at = *next;
        weight *= onward->weight * straight_transmittance(light.scene, at) *
                  volume_transmittance(light.volumes, ray.from, ray.direction, at.distance);
        if (!(largest_band(weight) > kLeastGathered)) return;
    }
}

// Behind a thin-walled surface; as effects/sheet has it.
Receiver behind(const Receiver& front, const BodyPoint& inside) {
    const glm::vec3 moved = front.origin - (2.0f * inside.position - inside.inner);
    return {inside.inner + moved, -front.normal};
}

glm::dvec3 band_colors(formats::Rgb c) {
    return {c.r, c.g, c.b};
}

formats::Rgb radiance_of(const glm::dvec3& exitance) {
    const glm::vec3 c(exitance * std::numbers::inv_pi);
    return {c.x, c.y, c.z};
}

}  // namespace

std::optional<TextureView> view_of_cone(const LampLight& light, const Arrival& at,
                                        const glm::vec3& direction, double solid_angle) {
    const formats::Primitive& primitive = light.scene.primitives[at.side.primitive];
    if (light.textures == nullptr ||
        !has_pyramid(*light.textures, light.scene.materials[primitive.material])) {
        return std::nullopt;
    }
    return TextureView{*light.textures,
                       moments_of_cone(uv_gradient(primitive, at.side.first_index), direction,
                                       glm::vec3(at.normal), at.distance, solid_angle)};
}

void add_reflected(const LampLight& light, const Arrival& at, const glm::dvec3& weight,
                   const TextureView* view, std::vector<glm::dvec3>& sum) {
    const TriangleSide& side = at.side;
    const glm::vec3 weights(at.weights);
    if (light.media != nullptr && !side.is_back && side.primitive < light.media->exitance.size() &&
        !light.media->exitance[side.primitive].empty()) {
        for (std::size_t lamp = 0; lamp < sum.size(); ++lamp) {
            sum[lamp] +=
                weight * media_exitance(light.scene, *light.media, lamp, side, weights, view);
        }
        return;
    }
    const BounceColor color = bounce_color(light.scene, side, weights, view);
    const auto add = [&](const glm::dvec3& share, bool is_back) {
        if (share == glm::dvec3(0)) return;
        const std::size_t element =
            light.layout.element({side.primitive, side.first_index, is_back}, at.weights);
        if (element == light.layout.size()) return;
        for (std::size_t lamp = 0; lamp < sum.size(); ++lamp) {
            if (!light.elements[lamp].empty()) {
                sum[lamp] += weight * share * glm::dvec3(light.elements[lamp].irradiance[element]);
            }
        }
    };
    add(color.reflect, side.is_back);
    add(color.transmit, !side.is_back);
}

std::vector<glm::dvec3> receive_light(const LampLight& light, const Receiver& receiver,
                                      std::uint64_t key, std::uint64_t& rays) {
    std::vector<glm::dvec3> total(light.sources.size(), glm::dvec3(0));
    if (receiver.normal == glm::vec3(0)) return total;
    if (has_bounces(light) && !light.rays.is_empty()) {
        const auto shift = random_uniform(light.seed, RandomStage::gather_rays, key);
        const Frame frame = make_frame(receiver.normal);
        for (std::uint32_t first = 0; first < light.samples; first += RayPacket::kSize) {
            RayPacket packet = rays_from(receiver.origin);
            LaneMask lanes{};
            const std::uint32_t count = std::min(light.samples - first, RayPacket::kSize);
            for (std::uint32_t lane = 0; lane < count; ++lane) {
                const glm::dvec2 u = spread_point({shift[0], shift[1]}, first + lane);
                const DiskPoint disk = map_to_disk(u.x, u.y);
                const glm::dvec2 across = disk.radius * disk.outward;
                set_lane(packet, lanes, lane,
                         frame.to_world(
                             glm::vec3(across.x, across.y, std::sqrt(std::max(0.0, 1 - disk.q)))));
            }
            const PacketHits hits = light.rays.closest(lanes, packet);
            for (std::uint32_t lane = 0; lane < count; ++lane) {
                const auto at = arrival_of(hits, lane);
                if (!at) continue;
                const glm::vec3 direction = direction_of(packet, lane);
                const double cell =
                    cell_of_ray(glm::dot(direction, receiver.normal), light.samples);
                const auto view = view_of_cone(light, *at, direction, cell);
                gather_along(
                    light, {glm::dvec3(receiver.origin), glm::dvec3(direction), key, first + lane},
                    *at, view ? &*view : nullptr, total, rays);
            }
        }
        rays += light.samples;
        for (glm::dvec3& sum : total) {
            sum /= light.samples;
        }
    }
    add_caustics(light, receiver, total, rays);
    for (std::size_t lamp = 0; lamp < total.size(); ++lamp) {
        total[lamp] += straight_irradiance(light.rays, light.sources[lamp], receiver, light.samples,
                                           rays, light.volumes);
        if (lamp >= light.glow.size() || light.glow[lamp] == nullptr) continue;
        const auto turn = random_uniform(light.seed, RandomStage::gather_rays, key,
                                         ~static_cast<std::uint32_t>(lamp));
        total[lamp] +=
            glow_irradiance(*light.glow[lamp], light.rays, receiver,
                            std::max(kLeastGlowRays, light.samples / 4), {turn[0], turn[1]}, rays);
    }
    return total;
}

void add_caustics(const LampLight& light, const Receiver& receiver, std::span<glm::dvec3> total,
                  std::uint64_t& rays) {
    if (std::ranges::all_of(light.caustics, &ElementLight::empty)) return;
    const ElementLayout& layout =
        light.caustic_layout != nullptr ? *light.caustic_layout : light.layout;
    // Four rays down to the elements around the receiver: at a vertex some of those that meet
    // there.
    constexpr std::uint32_t kRays = 4;
    RayPacket packet = rays_from(receiver.origin);
    LaneMask lanes{};
    const Frame frame = make_frame(receiver.normal);
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const glm::vec3 across(i == 0 ? 1 : i == 1 ? -1 : 0, i == 2 ? 1 : i == 3 ? -1 : 0, -1);
        set_lane(packet, lanes, i, glm::normalize(frame.to_world(across)),
                 static_cast<float>(kNear * light.sources.front().radius));
    }
    rays += kRays;
    const PacketHits hits = light.rays.closest(lanes, packet);
    std::array<std::size_t, kRays> elements{};
    std::size_t count = 0;
    for (std::uint32_t i = 0; i < kRays; ++i) {
        const auto at = arrival_of(hits, i);
        if (!at || glm::dot(at->normal, glm::dvec3(receiver.normal)) < 0.5) continue;
        const std::size_t element = layout.element(at->side, at->weights);
        if (element < layout.size()) elements[count++] = element;
    }
    for (std::size_t lamp = 0; lamp < light.caustics.size(); ++lamp) {
        if (light.caustics[lamp].empty()) continue;
        for (std::size_t i = 0; i < count; ++i) {
            total[lamp] += glm::dvec3(light.caustics[lamp].irradiance[elements[i]]) /
                           static_cast<double>(count);
        }
    }
}

std::vector<std::vector<formats::Rgb>> make_lamp_rows(const LampLight& light,
                                                      const ReceiverSet& set, std::uint32_t terms,
                                                      const Context& context, std::uint64_t& rays) {
    std::vector<std::vector<formats::Rgb>> rows(light.sources.size(),
                                                std::vector<formats::Rgb>(set.size() * terms));
    const auto& sheet = light.scene.materials[set.material].sheet;
    struct Part {
        std::vector<std::vector<glm::dvec3>> front, back;  // by receiver, by lamp
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        set.size(), kReceiversPerBlock, context,
        [&](Range range) {
            Part part;
            for (std::size_t r = range.begin; r < range.end; ++r) {
                const std::uint64_t key = 2 * (std::uint64_t{set.first} + r);
                part.front.push_back(receive_light(light, set.outside[r], key, part.rays));
                if (sheet) {
                    part.back.push_back(receive_light(light, behind(set.outside[r], set.inside[r]),
                                                      key + 1, part.rays));
                }
            }
            return part;
        },
        [&](Range range, Part&& part) {
            for (std::size_t r = range.begin; r < range.end; ++r) {
                for (std::size_t lamp = 0; lamp < rows.size(); ++lamp) {
                    const glm::dvec3& front = part.front[r - range.begin][lamp];
                    if (!sheet) {
                        rows[lamp][r * terms] = radiance_of(front);
                        continue;
                    }
                    const glm::dvec3& back = part.back[r - range.begin][lamp];
                    const glm::dvec3 reflect = band_colors(sheet->reflect),
                                     transmit = band_colors(sheet->transmit);
                    rows[lamp][r * terms] = radiance_of(reflect * front + transmit * back);
                    rows[lamp][r * terms + 1] = radiance_of(transmit * front + reflect * back);
                }
            }
            rays += part.rays;
        });
    return rows;
}

}  // namespace opaline::bake
