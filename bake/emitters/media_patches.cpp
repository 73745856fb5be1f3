#include "bake/emitters/media_patches.h"

#include <algorithm>

#include "bake/base/ordered_parallel.h"
#include "bake/exchange/other_light.h"
#include "bake/exchange/patch_light.h"
#include "bake/plan/medium_exitance.h"
#include "bake/receivers/receiver.h"
#include "bake/receivers/surface_patches.h"
#include "bake/scattering/fresnel.h"
#include "formats/opal/cubemap.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kProbes = 3;  // of a patch
constexpr std::uint32_t kRaysOfProbe = 64;

std::uint32_t basis_for(std::size_t receivers) {
    std::uint32_t n = 1;
    while (n < kPatchBasis && formats::cubemap_texels(n) < receivers)
        n *= 2;
    return n;
}

// A few members of each patch, evenly spaced.
std::vector<std::vector<std::uint32_t>> choose_probes(const LitMedium& medium,
                                                      std::span<const std::uint32_t> patch) {
    const std::size_t count = 1 + *std::ranges::max_element(patch);
    std::vector<std::vector<std::uint32_t>> members(count);
    for (std::uint32_t i = 0; i < patch.size(); ++i) {
        if (medium.outside[i].normal != glm::vec3(0)) members[patch[i]].push_back(i);
    }
    for (std::vector<std::uint32_t>& own : members) {
        if (own.size() <= kProbes) continue;
        for (std::size_t k = 0; k < kProbes; ++k) {
            own[k] = own[(2 * k + 1) * own.size() / (2 * kProbes)];
        }
        own.resize(kProbes);
    }
    return members;
}

}  // namespace

MediumPatches find_patches(const LitMedia& media, const LampLight& light, const LitMedium& medium,
                           const Context& context, std::uint64_t& rays) {
    const std::uint32_t n = basis_for(medium.inside.size());
    const std::size_t columns = formats::cubemap_texels(n);
    MediumPatches patches;
    patches.of_receiver = cut_into_patches(medium.inside, columns);
    patches.probes = choose_probes(medium, patches.of_receiver);
    std::vector<Receiver> outside;
    std::vector<BodyPoint> inside;
    for (const std::vector<std::uint32_t>& probes : patches.probes) {
        for (const std::uint32_t i : probes) {
            outside.push_back(medium.outside[i]);
            inside.push_back(medium.inside[i]);
        }
    }
    const PatchLight columns_of{
        PatchLight::Receivers{light.scene, light.rays, medium.primitives, medium.first},
        patches.of_receiver};
    const OtherLight light_of_patches{.patches = &columns_of, .bands = 1, .environment = false};
    const std::vector<std::vector<float>> rows =
        light_medium(*media.finished, {medium.material, outside, inside, light_of_patches, n, true},
                     context, rays);
    if (rows.size() != outside.size() || context.cancelled()) return {};
    patches.mirrored = static_cast<float>(
        fresnel_moments(static_cast<double>(light.scene.materials[medium.material].medium->eta))
            .external);
    patches.answer.assign(patches.size() * patches.size(), glm::vec3(0));
    std::size_t row = 0;
    for (std::size_t to = 0; to < patches.size(); ++to) {
        const std::vector<std::uint32_t>& probes = patches.probes[to];
        for (const std::uint32_t i : probes) {
            const std::vector<glm::vec3> exitance =
                exitance_of_row(weigh_rows_at(media, light.scene, medium, i), medium.color[i],
                                rows[row++], columns);
            for (std::size_t from = 0; from < patches.size(); ++from) {
                patches.answer[to * patches.size() + from] +=
                    exitance[from] / static_cast<float>(probes.size());
            }
        }
    }
    return patches;
}

std::vector<glm::vec3> light_patches(const MediumPatches& patches, const LampLight& light,
                                     const LitMedium& medium, const Context& context,
                                     std::uint64_t& rays) {
    const std::size_t lamps = light.sources.size(), size = patches.size();
    LampLight coarse = light;
    coarse.samples = std::min(coarse.samples, kRaysOfProbe);
    struct Part {
        std::vector<glm::dvec3> irradiance;
        std::uint64_t rays = 0;
    };
    std::vector<glm::vec3> irradiance(lamps * size, glm::vec3(0));
    constexpr std::size_t kBlock = 4;
    for_each_block_in_order(
        size, kBlock, context,
        [&](Range range) {
            Part part;
            part.irradiance.assign((range.end - range.begin) * lamps, glm::dvec3(0));
            for (std::size_t j = range.begin; j < range.end; ++j) {
                for (const std::uint32_t i : patches.probes[j]) {
                    const std::vector<glm::dvec3> own = receive_light(
                        coarse, medium.outside[i], key_of(medium.outside[i]), part.rays);
                    for (std::size_t e = 0; e < lamps; ++e) {
                        part.irradiance[(j - range.begin) * lamps + e] +=
                            own[e] / static_cast<double>(patches.probes[j].size());
                    }
                }
            }
            return part;
        },
        [&](Range range, Part&& part) {
            for (std::size_t j = range.begin; j < range.end; ++j) {
                for (std::size_t e = 0; e < lamps; ++e) {
                    irradiance[e * size + j] =
                        glm::vec3(part.irradiance[(j - range.begin) * lamps + e]);
                }
            }
            rays += part.rays;
        });
    return irradiance;
}

std::vector<glm::vec3> answer_patches(const MediumPatches& patches,
                                      std::span<const glm::vec3> irradiance) {
    const std::size_t size = patches.size();
    std::vector<glm::vec3> exitance(irradiance.size(), glm::vec3(0));
    for (std::size_t i = 0; i < exitance.size(); ++i) {
        const std::size_t to = i % size, lamp = i - to;
        for (std::size_t from = 0; from < size; ++from) {
            exitance[i] += patches.answer[to * size + from] * irradiance[lamp + from];
        }
        exitance[i] = glm::max(exitance[i], glm::vec3(0)) + patches.mirrored * irradiance[i];
    }
    return exitance;
}

std::vector<LitMedium> list_lit_media(const LitMedia& media, std::span<const ReceiverSet> receivers,
                                      std::span<const formats::PrimitiveRecord> primitives) {
    std::vector<LitMedium> lit;
    if (media.finished == nullptr) return lit;
    for (std::uint32_t m = 0; m < media.layouts.size(); ++m) {
        LitMedium medium;
        medium.material = m;
        for (std::uint32_t p = 0; p < receivers.size(); ++p) {
            const ReceiverSet& set = receivers[p];
            if (set.size() == 0 || set.material != m ||
                primitives[p].shading != formats::Shading::translucent) {
                continue;
            }
            medium.primitives.push_back(p);
            medium.first.push_back(static_cast<std::uint32_t>(medium.outside.size()));
            medium.outside.insert(medium.outside.end(), set.outside.begin(), set.outside.end());
            medium.inside.insert(medium.inside.end(), set.inside.begin(), set.inside.end());
            const auto color = media.color.subspan(primitives[p].first_vertex, set.size());
            medium.color.insert(medium.color.end(), color.begin(), color.end());
        }
        if (!medium.primitives.empty()) lit.push_back(std::move(medium));
    }
    return lit;
}

std::vector<glm::vec3> exitance_of_row(std::span<const float> weights, formats::Rgb color,
                                       std::span<const float> row, std::size_t columns) {
    std::vector<glm::vec3> exitance(columns, glm::vec3(0));
    for (std::size_t k = 0; k < weights.size(); ++k) {
        for (int b = 0; b < 3; ++b) {
            const float* const plane = &row[(3 * k + static_cast<std::size_t>(b)) * columns];
            for (std::size_t i = 0; i < columns; ++i) {
                exitance[i][b] += weights[k] * plane[i];
            }
        }
    }
    for (glm::vec3& value : exitance) {
        value = glm::max(value, glm::vec3(0)) * glm::vec3(color.r, color.g, color.b);
    }
    return exitance;
}

std::vector<float> weigh_rows_at(const LitMedia& media, const formats::Scene& scene,
                                 const LitMedium& medium, std::size_t receiver) {
    return weigh_rows_of_medium(media.layouts[medium.material],
                                scene.materials[medium.material].medium->eta,
                                medium.inside[receiver].normal);
}

}  // namespace opaline::bake
