#include "bake/volumes/lit_vertex.h"

#include <algorithm>
#include <array>
#include <numbers>

#include "bake/receivers/other_side.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// Sides of a body's vertex of which less is open answer to light of the sky by chance.
constexpr float kLeastOpen = 0.1f;

float in_band_of(formats::Rgb c, std::uint32_t band, std::uint32_t bands) {
    return bands == 1 ? formats::luminance(c) : std::array<float, 3>{c.r, c.g, c.b}[band];
}

}  // namespace

LitVertex light_vertex(const SentLight& light, const ReceiverSet& set, std::size_t vertex,
                       formats::Shading shading) {
    LitVertex lit;
    lit.front = gather_sent_light(light, set.outside[vertex]);
    if (shading == formats::Shading::sheet) {
        lit.back = gather_sent_light(light, other_side(set.outside[vertex], set.inside[vertex]));
    }
    return lit;
}

LitRow answer_of_surface(const formats::Material& material, std::uint32_t term, std::uint32_t band,
                         std::uint32_t bands) {
    constexpr float kShare = std::numbers::inv_pi_v<float>;
    if (!material.sheet) {
        return {kShare, 0};
    }
    const float r = kShare * in_band_of(material.sheet->reflect, band, bands);
    const float t = kShare * in_band_of(material.sheet->transmit, band, bands);
    return term == 0 ? LitRow{r, t} : LitRow{t, r};
}

LitRow answer_of_medium(std::span<const float> texels, std::span<const double> solid_angles,
                        float open) {
    double even = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        even += static_cast<double>(texels[i]) * solid_angles[i % solid_angles.size()];
    }
    return {static_cast<float>(even) * std::numbers::inv_pi_v<float> / std::max(open, kLeastOpen),
            0};
}

void add_sent_light(const SentLight& light, const LitVertex& lit, const LitRow& answer,
                    std::uint32_t band, std::uint32_t n, std::span<float> texels) {
    const std::size_t cells = light.cells.size();
    const std::size_t first = light.bands() == 1 ? 0 : band * cells;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const std::size_t cell = first + coarser_texel(i, n, light.cells.n);
        texels[i] += answer.front * lit.front.rows[cell];
        if (!lit.back.rows.empty()) {
            texels[i] += answer.back * lit.back.rows[cell];
        }
    }
}

}  // namespace opaline::bake
