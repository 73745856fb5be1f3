#include "bake/exchange/medium_answer.h"

#include <algorithm>
#include <cassert>
#include <glm/glm.hpp>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/physics/fresnel.h"
#include "bake/plan/medium_exitance.h"
#include "bake/receivers/surface_patches.h"

namespace opaline::bake {
namespace {

constexpr std::size_t kPlane = kMostPatches;

// The dipole may return more than enters, as its half space ends nowhere; walks' rows vary.
void bound(MediumAnswer& answer, std::span<const float> enters) {
    for (std::uint32_t to = 0; to < answer.patches; ++to) {
        const std::span<BandColour> row =
            std::span(answer.share).subspan(std::size_t{to} * answer.patches, answer.patches);
        const BandColour sum = answer.sum_of(to);
        const float most = enters[to];
        for (std::size_t b = 0; b < sum.size(); ++b) {
            if (!(sum[b] > most)) continue;
            for (BandColour& share : row) {
                share[b] *= most / sum[b];
            }
        }
    }
}

}  // namespace

BandColour in_bands(const BandColour& colour, std::uint32_t bands) {
    return bands == 1 ? BandColour{formats::luminance({colour[0], colour[1], colour[2]})} : colour;
}

BandColour MediumAnswer::sum_of(std::uint32_t to) const {
    BandColour sum{};
    for (std::size_t from = 0; from < patches; ++from) {
        for (std::size_t b = 0; b < sum.size(); ++b) {
            sum[b] += share[std::size_t{to} * patches + from][b];
        }
    }
    return sum;
}

MediumAnswer cut_medium(std::span<const Scatterer> scatterers, std::span<const float> cells,
                        std::vector<std::uint32_t> members) {
    MediumAnswer answer;
    answer.members = std::move(members);
    // Each material has patches of its own.
    const std::size_t all = answer.members.size();
    for (std::size_t begin = 0, end = 0; begin < all; begin = end) {
        std::vector<BodyPoint> inside;
        const std::uint32_t material = scatterers[answer.members[begin]].material;
        while (end < all && scatterers[answer.members[end]].material == material) {
            inside.push_back(scatterers[answer.members[end++]].inside);
        }
        const std::size_t most = std::max<std::size_t>(1, kMostPatches * inside.size() / all);
        const std::vector<std::uint32_t> own = cut_into_patches(inside, most);
        for (const std::uint32_t p : own) {
            answer.patch.push_back(answer.patches + p);
        }
        answer.patches += 1 + std::ranges::max(own);
    }
    // Cells of scatterers at one place have no area.
    constexpr float kNoArea = 1e-30f;
    std::vector<float> area(answer.patches);
    for (std::size_t m = 0; m < answer.members.size(); ++m) {
        area[answer.patch[m]] += std::max(cells[answer.members[m]], kNoArea);
    }
    for (std::size_t m = 0; m < answer.members.size(); ++m) {
        answer.part.push_back(std::max(cells[answer.members[m]], kNoArea) / area[answer.patch[m]]);
    }
    answer.share.assign(std::size_t{answer.patches} * answer.patches, {});
    return answer;
}

void set_shares(const LightInputs& inputs, std::span<const Scatterer> scatterers,
                std::span<const std::vector<float>> rows, MediumAnswer& answer) {
    if (inputs.context.cancelled() || rows.empty()) return;
    assert(rows.size() == answer.members.size());
    std::vector<float> count(answer.patches), enters(answer.patches);
    for (const std::uint32_t p : answer.patch) {
        count[p] += 1;
    }
    for (std::size_t m = 0; m < rows.size(); ++m) {
        const std::uint32_t to = answer.patch[m];
        const std::uint32_t material = scatterers[answer.members[m]].material;
        const RowLayout& layout = inputs.layouts[material];
        const std::uint32_t own_bands = layout.bands();
        const float eta = inputs.bake.scene.materials[material].medium->eta;
        if (!(enters[to] > 0)) {
            enters[to] = static_cast<float>(1 - fresnel_moments(double{eta}).external);
        }
        if (rows[m].empty()) continue;
        const std::vector<float> weight =
            weigh_rows_of_medium(layout, eta, scatterers[answer.members[m]].inside.normal);
        for (std::size_t k = 0; k < weight.size(); ++k) {
            const float factor = weight[k] / count[to];
            for (std::uint32_t b = 0; b < 3; ++b) {
                const std::size_t plane = k * own_bands + std::min(b, own_bands - 1);
                for (std::size_t from = 0; from < answer.patches; ++from) {
                    answer.share[to * std::size_t{answer.patches} + from][b] +=
                        factor * rows[m][plane * kPlane + from];
                }
            }
        }
    }
    for (BandColour& share : answer.share) {
        std::ranges::for_each(share, [](float& s) { s = std::max(s, 0.0f); });
    }
    bound(answer, enters);
}

void add_answer(const MediumAnswer& answer, std::span<const Scatterer> scatterers,
                const CodedRows& irradiance, std::uint32_t bands, const Context& context,
                CodedRows& radiosity) {
    const std::size_t size = irradiance.size(), patches = answer.patches, plane = size / bands;
    assert(size == bands * plane && radiosity.size() == size);
    std::vector<float> mean(patches * size);
    const auto row_of = [&](std::vector<float>& rows, std::size_t patch) {
        return std::span(rows).subspan(patch * size, size);
    };
    for (std::size_t m = 0; m < answer.members.size(); ++m) {
        irradiance.add(answer.members[m], answer.part[m], row_of(mean, answer.patch[m]));
    }
    std::vector<float> others(patches * size);
    for_each_block_in_order(
        patches, 8, context,
        [&](Range range) {
            for (std::size_t to = range.begin; to < range.end; ++to) {
                const std::span<float> sum = row_of(others, to);
                for (std::size_t from = 0; from < patches; ++from) {
                    const BandColour& share = answer.share[to * patches + from];
                    if (from == to) continue;
                    for (std::size_t b = 0; b < bands; ++b) {
                        const float* const e = &mean[from * size + b * plane];
                        float* const s = &sum[b * plane];
                        for (std::size_t t = 0; t < plane; ++t) {
                            s[t] += share[b] * e[t];
                        }
                    }
                }
            }
            return 0;
        },
        [](Range, int) {});
    for_each_block_in_order(
        answer.members.size(), 64, context,
        [&](Range range) {
            for (std::size_t m = range.begin; m < range.end; ++m) {
                const std::uint32_t i = answer.members[m], p = answer.patch[m];
                std::vector<float> own = irradiance.row(i), to = radiosity.row(i);
                const formats::Rgb c = scatterers[i].albedo.diffuse;
                const BandColour colour = in_bands({c.r, c.g, c.b}, bands);
                for (std::size_t k = 0; k < size; ++k) {
                    const std::size_t b = k / plane;
                    to[k] += colour[b] *
                             (answer.share[p * patches + p][b] * own[k] + others[p * size + k]);
                }
                radiosity.set(i, to);
            }
            return 0;
        },
        [](Range, int) {});
}

}  // namespace opaline::bake
