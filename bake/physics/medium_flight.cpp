#include "bake/physics/medium_flight.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "formats/media/mean_cosine.h"

namespace opaline::bake {
namespace {

using Bands = std::array<float, 3>;

}  // namespace

std::array<float, 3> isotropic_scattering(const formats::Medium& medium) {
    const auto isotropic = static_cast<float>(1 - formats::mean_cosine(medium.phase));
    const formats::Rgb& s = medium.sigma_s;
    return {isotropic * s.r, isotropic * s.g, isotropic * s.b};
}

MediumFlight draw_flight(const formats::Medium& medium, const Bands& share, float distance, float u,
                         float v) {
    const Bands sigma_s = isotropic_scattering(medium);
    const Bands sigma_a{medium.sigma_a.r, medium.sigma_a.g, medium.sigma_a.b};
    Bands sigma_t{};
    for (std::size_t b = 0; b < 3; ++b) {
        sigma_t[b] = sigma_s[b] + sigma_a[b];
    }
    const float sum = share[0] + share[1] + share[2];
    if (!(std::ranges::max(sigma_s) > 0) || !(sum > 0)) {
        MediumFlight crossing{{}, share};
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
    MediumFlight flight{scatters ? std::optional(length) : std::nullopt, {}};
    for (std::size_t b = 0; b < 3; ++b) {
        flight.share[b] = density > 0 ? share[b] * light[b] / density : 0;
    }
    return flight;
}

glm::vec3 direction_on_sphere(float u, float v) {
    const float z = 1 - 2 * u, r = std::sqrt(std::max(0.0f, 1 - z * z));
    const float azimuth = 2 * std::numbers::pi_v<float> * v;
    return {r * std::cos(azimuth), r * std::sin(azimuth), z};
}

}  // namespace opaline::bake
