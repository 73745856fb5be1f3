#include "bake/exchange/other_light.h"

#include <algorithm>
#include <cstddef>
#include <numbers>

#include "bake/exchange/exchange_points.h"
#include "bake/exchange/lamp_bounces.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};

void add_plane(std::span<const float> from, float factor, std::span<float> to) {
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k] += factor * from[k];
    }
}

std::uint64_t add_lamps(const LampBounces& light, const LitPoint& point, std::uint32_t n,
                        std::span<float> rows) {
    std::uint64_t rays = 0;
    const std::vector<glm::dvec3> irradiance =
        receive_light(light, point, key_of(point.receiver), rays);
    const std::size_t texels = formats::cubemap_texels(n);
    for (std::size_t e = 0; e < irradiance.size(); ++e) {
        for (int b = 0; b < 3; ++b) {
            rows[static_cast<std::size_t>(b) * texels + e] += static_cast<float>(irradiance[e][b]);
        }
    }
    return rays;
}

}  // namespace

std::uint64_t add_irradiance(const OtherLight& light, const LitPoint& point,
                             std::uint32_t cubemap_size, std::span<float> rows) {
    if (light.patches != nullptr) {
        add_patch(*light.patches, point.receiver, rows);
        return 0;
    }
    if (light.lamps != nullptr) return add_lamps(*light.lamps, point, cubemap_size, rows);
    return add_bounced(*light.surfaces, point, cubemap_size, rows);
}

std::uint64_t add_other_light(const OtherLight* light, const Receiver& receiver,
                              std::initializer_list<OtherLightShare> shares, const DenseRow& row) {
    if (light == nullptr) return 0;
    std::vector<float> irradiance(light->bands * row.size());
    const std::uint64_t rays = add_irradiance(*light, {receiver}, row.cubemap_size, irradiance);
    const auto plane = [&](std::size_t band) {
        return std::span<const float>(irradiance).subspan(band * row.size(), row.size());
    };
    for (const OtherLightShare& share : shares) {
        for (std::uint32_t band = 0; band < row.bands; ++band) {
            const std::span<float> to = row.plane(share.term, band);
            if (light->bands == 1 || row.bands == 3) {
                add_plane(plane(light->bands == 1 ? 0 : band), share.factor[band], to);
                continue;
            }
            for (std::size_t b = 0; b < kLuminance.size(); ++b) {
                add_plane(plane(b), kLuminance[b] * share.factor[band], to);
            }
        }
    }
    return rays;
}

std::optional<BounceTruth> true_light_of(const EffectInputs& inputs,
                                         std::span<const TestLight> lights) {
    const OtherLight* const light = light_of(inputs);
    if (light == nullptr || !light->surfaces) return std::nullopt;
    return make_bounce_truth(light->surfaces, lights, inputs.bake.between);
}

std::uint64_t add_true_other_light(const std::optional<BounceTruth>& light,
                                   const Receiver& receiver, std::uint64_t key, double share,
                                   TwoEstimates& radiance) {
    // Of each estimate; paths meet suns in lobes by chance.
    constexpr std::uint32_t kSamples = 128, kWithLobes = 512;
    if (!light) return 0;
    const std::uint32_t samples = light->light->tree.has_lobes() ? kWithLobes : kSamples;
    std::uint64_t rays = 0;
    for (const bool first : {true, false}) {
        Luminance& to = first ? radiance.first : radiance.second;
        Luminance irradiance(to.size());
        rays += add_true_bounces(*light, receiver, 2 * key + (first ? 0 : 1), samples, irradiance);
        for (std::size_t l = 0; l < to.size(); ++l) {
            to[l] += share * std::numbers::inv_pi * irradiance[l];
        }
    }
    return rays;
}

}  // namespace opaline::bake
