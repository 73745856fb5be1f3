#include "runtime/normal_maps/turned_light.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/texel_integrals.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

constexpr float kShareOfLeast = 1.0f / 64;

// Irradiance over pi of a unit of radiance in degree l [Ramamoorthi2001], times the factor of Y_k
// before its polynomial (formats/README.md, "View terms").
constexpr std::array<float, 9> kFactors = {
    1 * 0.2820948f,       2 / 3.f * 0.4886025f, 2 / 3.f * 0.4886025f,
    2 / 3.f * 0.4886025f, 0.25f * 1.0925484f,   0.25f * 1.0925484f,
    0.25f * 0.3153916f,   0.25f * 1.0925484f,   0.25f * 0.5462742f};

float positive(float x) {
    return x > 0 ? x : 0.0f;
}

Rgb smooth_light(const TurnedLight& light, Vec3 n) {
    const auto& h = light.harmonics;
    const Rgb sum = h[0] + n.y * h[1] + n.z * h[2] + n.x * h[3] + (n.x * n.y) * h[4] +
                    (n.y * n.z) * h[5] + (3 * n.z * n.z - 1) * h[6] + (n.x * n.z) * h[7] +
                    (n.x * n.x - n.y * n.y) * h[8];
    return {positive(sum.r), positive(sum.g), positive(sum.b)};
}

Rgb sun_light(const TurnedLight& light, Vec3 n) {
    Rgb sum{};
    for (const TurnedLight::Sun& sun : light.suns) {
        sum = sum + positive(dot(n, sun.direction)) * sun.light;
    }
    return sum;
}

float total(Rgb c) {
    return c.r + c.g + c.b;
}

// One band of L'.
float turn_band(float radiance, float from, float to, float least) {
    const float direct = std::min(radiance, from);
    const float below = from + least;
    return below > 0 ? radiance - direct + direct * ((to + least) / below) : radiance;
}

}  // namespace

TurnedLight make_turned_light(const LightVector& light) {
    const std::uint32_t n = light.n;
    const std::vector<double> integral = texel_integrals(light);
    const SplitLight split = split_suns(integral, n);
    std::array<std::array<double, 3>, 9> sums{};
    for (std::uint32_t j = 0; j < formats::cubemap_texels(n); ++j) {
        std::array<float, 9> value;
        formats::eval_spherical_harmonics(
            formats::texel_direction(n, j / (n * n), j / n % n, j % n), value);
        for (std::size_t k = 0; k < value.size(); ++k) {
            for (std::size_t band = 0; band < 3; ++band) {
                sums[k][band] +=
                    static_cast<double>(value[k]) * split.rest[std::size_t{3} * j + band];
            }
        }
    }
    TurnedLight turned;
    for (std::size_t k = 0; k < sums.size(); ++k) {
        turned.harmonics[k] =
            kFactors[k] * Rgb{static_cast<float>(sums[k][0]), static_cast<float>(sums[k][1]),
                              static_cast<float>(sums[k][2])};
    }
    turned.least = turned.harmonics[0];
    for (const Sun& sun : split.sun) {
        const Rgb facing = std::numbers::inv_pi_v<float> * Rgb{static_cast<float>(sun.light[0]),
                                                               static_cast<float>(sun.light[1]),
                                                               static_cast<float>(sun.light[2])};
        turned.suns.push_back({sun.direction, facing});
        turned.least = turned.least + 0.25f * facing;
    }
    turned.least = kShareOfLeast * Rgb{positive(turned.least.r), positive(turned.least.g),
                                       positive(turned.least.b)};
    return turned;
}

std::vector<TurnedLight> make_turned_lights(const PartLights& lights) {
    std::vector<TurnedLight> turned;
    turned.reserve(lights.light.size());
    for (const LightVector& light : lights.light) {
        turned.push_back(make_turned_light(light));
    }
    return turned;
}

Rgb turn_light(const TurnedLight& light, Rgb radiance, Vec3 from, Vec3 to) {
    const Rgb smooth = smooth_light(light, from), sun = sun_light(light, from);
    const float most = std::max(total(sun), total(light.least));
    const float share =
        most > 0 ? std::clamp((total(radiance) - total(smooth)) / most, 0.0f, 1.0f) : 0.0f;
    const Rgb a = smooth + share * sun;
    const Rgb b = smooth_light(light, to) + share * sun_light(light, to);
    return {turn_band(radiance.r, a.r, b.r, light.least.r),
            turn_band(radiance.g, a.g, b.g, light.least.g),
            turn_band(radiance.b, a.b, b.b, light.least.b)};
}

}  // namespace opaline::runtime
