#include "bake/exchange/inside_media.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "bake/receivers/receiver.h"
#include "bake/trace/cross_bodies.h"
#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

using Bands = std::array<float, 3>;

Bands bands_of(const formats::Rgb& c) {
    return {c.r, c.g, c.b};
}

struct Flight {
    std::optional<float> length{};  // [m] to a scattering; none: to the boundary
    Bands share{};
};

// One band is drawn in proportion to the light that the ray carries, and the balance heuristic over
// all of them weighs it, so that no flight makes the sum over bands larger.
Flight draw_flight(const formats::Medium& medium, const Bands& share, float distance, float u,
                   float v) {
    const auto isotropic = static_cast<float>(1 - formats::mean_cosine(medium.phase));
    const Bands sigma_s = bands_of(isotropic * medium.sigma_s), sigma_a = bands_of(medium.sigma_a);
    Bands sigma_t{};
    for (std::size_t b = 0; b < 3; ++b) {
        sigma_t[b] = sigma_s[b] + sigma_a[b];
    }
    const float sum = share[0] + share[1] + share[2];
    if (!(std::max({sigma_s[0], sigma_s[1], sigma_s[2]}) > 0) || !(sum > 0)) {
        Flight crossing{{}, share};
        for (std::size_t b = 0; b < 3; ++b) {
            crossing.share[b] *= std::exp(-sigma_a[b] * distance);
        }
        return crossing;
    }
    const std::size_t drawn = u * sum < share[0] ? 0 : u * sum < share[0] + share[1] ? 1 : 2;
    const float length = sigma_t[drawn] > 0 ? -std::log1p(-v) / sigma_t[drawn] : distance;
    const bool scatters = length < distance;
    const float way = scatters ? length : distance;
    // Relative to the band that was drawn, so that no density underflows in all of them.
    Bands light{};
    float density = 0;
    for (std::size_t b = 0; b < 3; ++b) {
        const float passed = std::exp(std::min((sigma_t[drawn] - sigma_t[b]) * way, 80.0f));
        light[b] = scatters ? sigma_s[b] * passed : passed;
        density += share[b] / sum * (scatters ? sigma_t[b] * passed : passed);
    }
    Flight flight{scatters ? std::optional(length) : std::nullopt, {}};
    for (std::size_t b = 0; b < 3; ++b) {
        flight.share[b] = density > 0 ? share[b] * light[b] / density : 0;
    }
    return flight;
}

glm::vec3 to_sphere(float u, float v) {
    const float z = 1 - 2 * u, r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

}  // namespace

bool is_inside(const BounceSpace& space, const RayEnd& end) {
    const formats::Material& material = space.scene.materials[end.material];
    return !end.side.is_seen && end.side.behind && end.side.normal != glm::vec3(0) &&
           material.medium && !material.sheet && !space.layouts.empty() &&
           !space.layouts[end.material].layered;
}

MirroredRay go_on_inside(const BounceSpace& space, const RayEnd& end, const formats::Rgb& share,
                         std::uint32_t number, std::uint64_t seed) {
    const formats::Medium& medium = *space.scene.materials[end.material].medium;
    const std::uint64_t key = key_of({end.position, end.direction});
    const auto of_flight = random_uniform(seed, RandomStage::bounce_rays, key, 0);
    const auto of_turn = random_uniform(seed, RandomStage::bounce_rays, key, 1);
    const Flight flight =
        draw_flight(medium, bands_of(share), end.distance, of_flight[0], of_flight[1]);
    MirroredRay on{.origin = end.position,
                   .direction = end.direction,
                   .share = {flight.share[0], flight.share[1], flight.share[2]},
                   .number = number,
                   .inside = 1};
    if (flight.length) {
        on.origin -= (end.distance - *flight.length) * end.direction;
        on.direction = to_sphere(of_turn[0], of_turn[1]);
        return on;
    }
    const glm::vec3 outward = -end.side.normal;
    const float ratio = 1 / medium.eta;
    bool leaves = true;
    if (!is_matched(ratio)) {
        const Bend bend = bend_at(outward, outward, end.direction, ratio);
        leaves = of_turn[2] < bend.passed;
        on.direction = leaves ? bend.refracted : bend.reflected;
    }
    on.origin += (leaves ? end.error : -end.error) * outward;
    return on;
}

}  // namespace opaline::bake
