#include "runtime/normal_maps/turned_light.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "formats/opal/cubemap.h"
#include "formats/opal/spherical_harmonics.h"
#include "runtime/texture.h"
#include "runtime/volumes/suns.h"
#include "runtime/volumes/texel_integrals.h"

namespace opaline::runtime {
namespace {

using formats::Vec3;

// As an image stores a coordinate: code 128 is 0, so that flat maps are flat.
float signed_code(float value) {
    return (255.0f * value - 128.0f) / 127.0f;
}

using formats::Rgb;

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

// A small light stands in up to four texels, all with one direction.
std::vector<TurnedLight::Sun> join_suns(std::span<const TurnedLight::Sun> suns) {
    constexpr float kSame = 0.9999f;  // within 0.8 degrees
    std::vector<TurnedLight::Sun> joined;
    for (const TurnedLight::Sun& sun : suns) {
        const auto found = std::ranges::find_if(joined, [&](const TurnedLight::Sun& other) {
            return dot(other.direction, sun.direction) > kSame;
        });
        if (found == joined.end()) {
            joined.push_back(sun);
        } else {
            found->light = found->light + sun.light;
        }
    }
    return joined;
}

// The sun's light among the harmonics.
void add_smooth(const TurnedLight::Sun& sun, std::array<Rgb, 9>& harmonics) {
    std::array<float, 9> value;
    formats::eval_spherical_harmonics(sun.direction, value);
    for (std::size_t k = 0; k < value.size(); ++k) {
        harmonics[k] =
            harmonics[k] + (std::numbers::pi_v<float> * kFactors[k] * value[k]) * sun.light;
    }
}

// One band of L'.
float turn_band(float radiance, float from, float to, float least) {
    const float direct = std::min(radiance, from);
    const float below = from + least;
    return below > 0 ? radiance - direct + direct * ((to + least) / below) : radiance;
}

}  // namespace

Vec3 mapped_normal(const formats::AssetView& asset, const formats::NormalMapRecord& map,
                   formats::Float2 texcoord, Vec3 normal, formats::DecodedTangent tangent) {
    const formats::Rgb value =
        sample_image_values(asset.images[map.image], texcoord, map.wrap_u, map.wrap_v);
    const Vec3 bitangent = tangent.sign * cross(normal, tangent.direction);
    const Vec3 mapped = (map.scale * signed_code(value.r)) * tangent.direction +
                        (map.scale * signed_code(value.g)) * bitangent +
                        signed_code(value.b) * normal;
    const float size = length(mapped);
    return size > 0 ? (1 / size) * mapped : normal;
}

ViewOfReceiver view_mapped(const ViewOfReceiver& view, Vec3 mapped) {
    constexpr float kLeastSeen = 0.05f;
    ViewOfReceiver bent = view;
    bent.normal = view.is_turned ? -1.0f * mapped : mapped;
    bent.cosine = dot(bent.normal, view.to_eye);
    const float least = std::min(view.cosine, kLeastSeen);
    if (bent.cosine < least) {
        const Vec3 toward = bent.normal + (least - bent.cosine) * view.to_eye;
        bent.normal = (1 / length(toward)) * toward;
        bent.cosine = dot(bent.normal, view.to_eye);
    }
    return bent;
}

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

TurnedLight turned_light_of_sheet(const TurnedLight& light, const formats::SheetShares& shares) {
    const Rgb both = shares.reflect + shares.transmit;
    const Rgb odd = shares.reflect + -1.0f * shares.transmit;
    TurnedLight turned = light;
    turned.suns = join_suns(light.suns);
    std::ranges::sort(turned.suns, std::ranges::greater{},
                      [](const TurnedLight::Sun& sun) { return total(sun.light); });
    while (turned.suns.size() > kMaxSuns / 2) {
        add_smooth(turned.suns.back(), turned.harmonics);
        turned.suns.pop_back();
    }
    for (std::size_t k = 0; k < turned.harmonics.size(); ++k) {
        turned.harmonics[k] = (k >= 1 && k <= 3 ? odd : both) * turned.harmonics[k];
    }
    const std::size_t suns = turned.suns.size();
    turned.suns.reserve(2 * suns);
    for (std::size_t i = 0; i < suns; ++i) {
        const TurnedLight::Sun sun = turned.suns[i];
        turned.suns[i].light = shares.reflect * sun.light;
        turned.suns.push_back({-1.0f * sun.direction, shares.transmit * sun.light});
    }
    turned.least = both * light.least;
    return turned;
}

TurnedLights make_turned_lights(const PartLights& lights,
                                std::span<const formats::PrimitiveRecord> primitives,
                                std::span<const formats::NormalMapRecord> maps) {
    TurnedLights turned;
    if (maps.empty()) return turned;
    for (const LightVector& light : lights.light) {
        turned.light.push_back(make_turned_light(light));
    }
    turned.of_primitive.assign(primitives.size(), TurnedLights::kNone);
    for (const formats::NormalMapRecord& map : maps) {
        std::uint32_t& of = turned.of_primitive[map.primitive];
        const auto number = static_cast<std::uint32_t>(lights.number(map.primitive));
        if (primitives[map.primitive].shading == formats::Shading::diffuse) {
            of = number;
        } else if (const formats::SheetShares shares = formats::sheet_shares_of(map);
                   primitives[map.primitive].shading == formats::Shading::sheet && shares.any()) {
            of = static_cast<std::uint32_t>(turned.light.size());
            turned.light.push_back(turned_light_of_sheet(turned.light[number], shares));
        }
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
