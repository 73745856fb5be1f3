#include "bake/effects/volumes/lamp_walks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "bake/base/frame.h"
#include "bake/effects/volumes/walk_parts.h"
#include "bake/exchange/lamps/onward_ray.h"
#include "bake/exchange/lamps/spread_points.h"
#include "bake/physics/path_differentials/axis_frame.h"
#include "bake/scene/punctual_light.h"
#include "bake/trace/packet_lane.h"
#include "formats/opal/spherical_harmonics.h"

namespace opaline::bake {
namespace {

// Light of a lamp that arrives at a point, if nothing is between.
struct LampRay {
    glm::vec3 direction{0};  // unit, toward the lamp
    float reach = 0;         // [m]
    glm::vec3 light{0};      // [lx] on what faces it
};

// Light of a point is spread over a ball of radius `blur` around it, in which it is even: with it
// 1/d^2 has the same integral, and no sample is far brighter than others. It is then dimmed as at
// half the radius in the mean, where it was at three quarters.
float spread_out(float distance, float blur) {
    return distance < blur ? 3 * distance * distance / (blur * blur) : 1.0f;
}
float way_dimmed(float distance, float blur) {
    return distance < blur ? 2.0f / 3 : 1.0f;
}

// A point of the lamp's triangles, the best of some that are drawn by power: each is taken in
// proportion to what it sends, and stands for their mean [Talbot2005].
std::optional<LampRay> draw_ray(const LitLamp& lamp, glm::vec3 at, float blur,
                                FlightRandom& random) {
    constexpr int kDrawn = 4;
    constexpr float kShadowEnd = 1 - 1e-4f;
    LampRay taken;
    float sum = 0, own = 0;
    for (int i = 0; i < kDrawn; ++i) {
        const double total = lamp.cumulative.back(), place = static_cast<double>(random()) * total;
        const std::size_t t = part_of_sum(lamp.cumulative, place);
        const GlowingTriangle& triangle = lamp.sources.triangles[t];
        const double chance = (lamp.cumulative[t] - (t == 0 ? 0 : lamp.cumulative[t - 1])) / total;
        const double u = random(), v = random();
        const glm::dvec3 way = sample_triangle_folded(triangle.corner, u, v).P - glm::dvec3(at);
        const float choice = random();
        const double square = glm::dot(way, way), distance = std::sqrt(square);
        const double facing = -glm::dot(triangle.normal, way);
        if (!(square > 0) || !(chance > 0) || (facing <= 0 && !triangle.is_two_sided)) continue;
        const glm::vec3 light(std::abs(facing) / (square * distance) * triangle.area / chance *
                              triangle.radiance);
        const float reach = static_cast<float>(distance), spread = spread_out(reach, blur);
        const float bright = spread * std::max({light.x, light.y, light.z});
        sum += bright;
        if (choice * sum < bright) {
            taken = {glm::vec3(way / distance), reach * kShadowEnd, spread * light};
            own = bright;
        }
    }
    if (!(own > 0)) return std::nullopt;
    taken.light *= sum / (static_cast<float>(kDrawn) * own);
    return taken;
}

// Calls visit(direction, light) for what arrives at a point from a lamp: one of its triangles and
// all its lights, a shadow ray each, dimmed by volumes.
template <class Visit>
std::uint64_t visit_lamp(const LampWalkSpace& walk, const LitLamp& lamp, glm::vec3 at, float blur,
                         FlightRandom& random, Visit&& visit) {
    std::uint64_t traced = 0;
    const auto arrive = [&](const LampRay& ray) {
        if (!walk.rays.is_empty()) {
            ++traced;
            if (is_hidden(walk.rays, at, ray.direction, ray.reach)) return;
        }
        const std::array<float, 3> depth = optical_depth(walk.space, at, ray.direction, ray.reach);
        visit(ray.direction, ray.light * glm::exp(-way_dimmed(ray.reach, blur) *
                                                  glm::vec3(depth[0], depth[1], depth[2])));
    };
    for (const formats::Light& light : lamp.sources.lights) {
        const ArrivingLight own = light_at(light, at);
        const formats::Rgb e = spread_out(own.distance, blur) * own.irradiance;
        if (e != formats::Rgb{}) arrive({own.to_light, own.distance, {e.r, e.g, e.b}});
    }
    if (!lamp.cumulative.empty()) {
        if (const auto ray = draw_ray(lamp, at, blur, random)) arrive(*ray);
    }
    return traced;
}

glm::vec3 as_vector(const std::array<float, 3>& weight) {
    return {weight[0], weight[1], weight[2]};
}

// Where a walk is, and what it still counts.
struct LampWalk {
    glm::vec3 at{0}, direction{0};
    std::array<float, 3> weight{};
};

// A surface reflects or lets through what lamps send to it, one of both by chance, and the walk
// goes on from it. False: it ends there.
bool turn_at_surface(const LampWalkSpace& walk, const WalkTrack& bands, const Arrival& met,
                     LampWalk& state, FlightRandom& random, std::span<glm::vec3> sum,
                     std::uint64_t& traced) {
    const BounceColor color = bounce_color(walk.scene, met.side, glm::vec3(met.weights));
    const double reflect = largest_band(color.reflect), transmit = largest_band(color.transmit);
    if (!(reflect + transmit > 0)) return false;
    const double chance = reflect / (reflect + transmit);
    const bool crosses = static_cast<double>(random()) >= chance;
    const glm::vec3 share(crosses ? color.transmit / (1 - chance) : color.reflect / chance);
    state.at =
        glm::vec3(leave_surface(glm::dvec3(state.at), glm::dvec3(state.direction), met, crosses));
    const glm::vec3 normal(crosses ? -met.normal : met.normal);
    if (!survives({share.x, share.y, share.z}, bands.first, bands.end, state.weight, random)) {
        return false;
    }
    const glm::vec3 sent = std::numbers::inv_pi_v<float> * as_vector(state.weight);
    for (std::size_t i = 0; i < sum.size(); ++i) {
        traced += visit_lamp(walk, walk.lamps[i], state.at, 0, random,
                             [&](glm::vec3 toward, glm::vec3 light) {
                                 const float cosine = glm::dot(toward, normal);
                                 sum[i] += std::max(cosine, 0.0f) * sent * light;
                             });
    }
    const float z = std::sqrt(random()), r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float angle = 2 * std::numbers::pi_v<float> * random();
    state.direction =
        glm::normalize(make_frame(normal).to_world({r * std::cos(angle), r * std::sin(angle), z}));
    return true;
}

// Adds to `sum`, one for each lamp, the light that arrives at a point from a direction: a walk
// against the light, which asks for each lamp wherever it is scattered.
std::uint64_t follow_to_lamps(const LampWalkSpace& walk, const WalkTrack& bands, LampWalk state,
                              float blur, FlightRandom& random, std::span<glm::vec3> sum) {
    std::uint64_t traced = 0;
    for (std::size_t band = bands.first; band < bands.end; ++band) {
        state.weight[band] = 1;
    }
    for (std::uint32_t n = 0; n < kMostScatterings; ++n) {
        std::optional<Arrival> met;
        if (!walk.rays.is_empty()) {
            met = find_arrival(walk.rays, state.at, state.direction);
            ++traced;
        }
        const float reach =
            met ? static_cast<float>(met->distance) : std::numeric_limits<float>::infinity();
        const Collision hit =
            sample_flight(walk.space, bands.first, state.at, state.direction, reach, random);
        if (!hit.happens) {
            if (!met || !turn_at_surface(walk, bands, *met, state, random, sum, traced)) break;
            continue;
        }
        state.at += hit.distance * state.direction;
        const DensityVolume& own = walk.space.volumes[hit.volume];
        if (!survives(own.albedo_at(state.at), bands.first, bands.end, state.weight, random)) {
            break;
        }
        for (std::size_t i = 0; i < sum.size(); ++i) {
            traced += visit_lamp(walk, walk.lamps[i], state.at, blur, random,
                                 [&](glm::vec3 toward, glm::vec3 light) {
                                     sum[i] +=
                                         eval_scaled(own.phase, glm::dot(state.direction, toward)) *
                                         as_vector(state.weight) * light;
                                 });
        }
        const SampledCosine sampled = turn_walk(own.phase, state.direction, random);
        for (float& w : state.weight) {
            w *= sampled.weight;
        }
    }
    return traced;
}

bool is_near(const LitLamp& lamp, glm::vec3 at, double distance) {
    if (!(lamp.box.low.x <= lamp.box.high.x)) return false;
    const glm::dvec3 place(at);
    return glm::length(place - glm::clamp(place, lamp.box.low, lamp.box.high)) < distance;
}

// What lamps send straight to a node, as harmonics: a mean over points around it, linear in their
// distances to the next nodes, so that a beam between nodes is not lost and light near a lamp is
// finite. Near a lamp points are many, and around one drawn at random.
std::uint64_t add_straight(const LampWalkSpace& walk, const LampReceiver& receiver, float size,
                           std::span<glm::vec3> out) {
    constexpr int kFew = 4, kMany = 8;
    static_assert(kFew * kFew * kFew == kStraightPoints);
    constexpr double kNear = 3, kAround = 1.8;  // distances of nodes; tents reach as far as sqrt 3
    std::uint64_t traced = 0;
    FlightRandom random(walk.seed, RandomStage::volume_glow, ~std::uint64_t{receiver.node});
    std::array<float, formats::kMaxHarmonics> view{};
    for (std::size_t i = 0; i < walk.lamps.size(); ++i) {
        const bool near = is_near(walk.lamps[i], receiver.position, kNear * double{size});
        const bool around = is_near(walk.lamps[i], receiver.position, kAround * double{size});
        const int side = near ? kMany : kFew;
        const float step = 2.0f / static_cast<float>(side);
        std::vector<glm::vec3> sum(receiver.terms);
        float all = 0;
        for (int point = 0; point < side * side * side; ++point) {
            const glm::vec3 cell(point % side, point / side % side, point / side / side);
            const glm::vec3 in = around ? glm::vec3(random(), random(), random()) : glm::vec3(0.5f);
            const glm::vec3 offset = step * (cell + in) - 1.0f;
            const glm::vec3 way = receiver.spacing * offset;
            const float distance = glm::length(way);
            if (!walk.rays.is_empty() && distance > 0) {
                ++traced;
                if (is_hidden(walk.rays, receiver.position, way / distance, distance)) continue;
            }
            const glm::vec3 tent = 1.0f - glm::abs(offset);
            const float weight = tent.x * tent.y * tent.z;
            all += weight;
            traced += visit_lamp(walk, walk.lamps[i], receiver.position + way, 0.5f * step * size,
                                 random, [&](glm::vec3 toward, glm::vec3 light) {
                                     formats::eval_spherical_harmonics(
                                         {toward.x, toward.y, toward.z},
                                         std::span(view).first(receiver.terms));
                                     for (std::size_t k = 0; k < sum.size(); ++k) {
                                         sum[k] += weight * view[k] * light;
                                     }
                                 });
        }
        for (std::size_t k = 0; k < sum.size() && all > 0; ++k) {
            out[i * receiver.terms + k] += sum[k] / all;
        }
    }
    return traced;
}

}  // namespace

LitLamp make_lit_lamp(const formats::Scene& scene, const Lamp& lamp) {
    LitLamp lit{make_lamp_sources(scene, lamp), {}, {}};
    double sum = 0;
    for (const GlowingTriangle& triangle : lit.sources.triangles) {
        const glm::dvec3 power = triangle.power();
        lit.cumulative.push_back(sum += power.x + power.y + power.z);
        for (const glm::dvec3& corner : triangle.corner) {
            lit.box.include(corner);
        }
    }
    if (!(sum > 0)) lit.cumulative.clear();
    for (const formats::Light& light : lit.sources.lights) {
        if (light.type != formats::Light::Type::directional) {
            lit.box.include(glm::dvec3(light.position));
        }
    }
    return lit;
}

std::uint64_t gather_lamps(const LampWalkSpace& walk, const LampReceiver& receiver,
                           const LampLightAtNode& out) {
    constexpr float kBlur = 0.5f;  // distances of nodes
    const float size = std::cbrt(std::abs(glm::determinant(receiver.spacing)));
    std::ranges::fill(out.straight, glm::vec3(0));
    std::ranges::fill(out.scattered, glm::vec3(0));
    std::ranges::fill(out.odd, glm::vec3(0));
    std::vector<glm::vec3> sum(walk.lamps.size());
    std::array<float, formats::kMaxHarmonics> view{};
    std::uint64_t traced = walk_from_node(
        walk.space, {walk.seed, RandomStage::volume_glow, receiver.node, receiver.walks}, sum,
        [&](const WalkTrack& bands, glm::vec3 direction, FlightRandom& random) {
            return follow_to_lamps(walk, bands, {receiver.position, direction, {}}, kBlur * size,
                                   random, sum);
        },
        [&](std::uint32_t i, glm::vec3 direction) {
            formats::eval_spherical_harmonics({direction.x, direction.y, direction.z},
                                              std::span(view).first(receiver.terms));
            for (std::size_t lamp = 0; lamp < sum.size(); ++lamp) {
                for (std::uint32_t k = 0; k < receiver.terms; ++k) {
                    const glm::vec3 light = view[k] * sum[lamp];
                    out.scattered[lamp * receiver.terms + k] += light;
                    if (i % 2 == 1) out.odd[lamp * receiver.terms + k] += light;
                }
            }
        });
    const auto share_of = [](std::uint32_t walks) {
        return 4 * std::numbers::pi_v<float> / static_cast<float>(std::max(walks, 1u));
    };
    const float share = share_of(receiver.walks), odd_share = share_of(receiver.walks / 2);
    traced += add_straight(walk, receiver, size, out.straight);
    const ScaledPhase& phase = walk.space.volumes[receiver.volume].phase;
    for (std::size_t i = 0; i < out.straight.size(); ++i) {
        const float factor =
            scattered_harmonic(phase, static_cast<std::uint32_t>(i % receiver.terms));
        out.straight[i] *= factor;
        out.scattered[i] *= share * factor;
        out.odd[i] *= odd_share * factor;
    }
    return traced;
}

}  // namespace opaline::bake
