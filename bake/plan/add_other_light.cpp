#include "bake/plan/add_other_light.h"

#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

namespace opaline::bake {
namespace {

constexpr std::array<float, 3> kLuminance{0.2126f, 0.7152f, 0.0722f};

void add_plane(std::span<const float> from, float factor, std::span<float> to) {
    for (std::size_t k = 0; k < to.size(); ++k) {
        to[k] += factor * from[k];
    }
}

}  // namespace

std::uint64_t add_other_light(const OtherLight* light, const Receiver& receiver,
                              std::initializer_list<OtherLightShare> shares, const DenseRow& row) {
    if (light == nullptr) return 0;
    std::vector<float> rows(light->bands * row.size());
    const std::uint64_t rays = light->add({receiver}, row.cubemap_size, rows);
    const auto plane = [&](std::size_t band) {
        return std::span<const float>(rows).subspan(band * row.size(), row.size());
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

std::uint64_t add_true_other_light(const OtherLight::TrueIrradiance& light,
                                   const Receiver& receiver, std::uint64_t key, double share,
                                   TwoEstimates& radiance) {
    constexpr std::uint32_t kSamples = 128;  // of each estimate
    std::uint64_t rays = 0;
    for (const bool first : {true, false}) {
        Luminance& to = first ? radiance.first : radiance.second;
        Luminance irradiance(to.size());
        if (light) {
            rays += light(receiver, 2 * key + (first ? 0 : 1), kSamples, irradiance);
        }
        for (std::size_t l = 0; l < to.size(); ++l) {
            to[l] += share * std::numbers::inv_pi * irradiance[l];
        }
    }
    return rays;
}

}  // namespace opaline::bake
