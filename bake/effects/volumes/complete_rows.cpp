#include "bake/effects/volumes/complete_rows.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

#include "bake/receivers/other_side.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "formats/opal/rgb.h"

namespace opaline::bake {
namespace {

// Sides of a body's vertex of which less is open answer to light of the sky by chance.
constexpr double kLeastOpen = 0.1;

constexpr std::uint32_t kFinestTransmittance = 16;  // texels along an edge of a face

float in_band_of(formats::Rgb c, std::uint32_t band, std::uint32_t bands) {
    return bands == 1 ? formats::luminance(c) : std::array<float, 3>{c.r, c.g, c.b}[band];
}

// Of texels, under an even sky of radiance 1.
double even_response(std::span<const float> texels, std::span<const double> solid_angles) {
    double even = 0;
    for (std::size_t i = 0; i < texels.size(); ++i) {
        even += static_cast<double>(texels[i]) * solid_angles[i % solid_angles.size()];
    }
    return even;
}

// What volumes scatter to both sides of a receiver; `back` is that of a sheet, otherwise empty.
struct SentToBoth {
    SentIrradiance front, back;
};

// Adds that to the texel values of one band of a row, 6 n n.
void add_sent_light(const SentLight& light, const SentToBoth& lit, const AnswerToSent& answer,
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

}  // namespace

VolumesBefore make_volumes_before(const formats::Scene& scene, const Knobs& knobs,
                                  const SentLight* sent) {
    return {make_density_space(scene),
            make_light_cells(std::min(knobs.cubemap_size, kFinestTransmittance)), sent};
}

AnswerToSent answer_of_surface(const formats::Material& material, std::uint32_t term,
                               std::uint32_t band, std::uint32_t bands) {
    constexpr float kShare = std::numbers::inv_pi_v<float>;
    if (!material.sheet) return {kShare, 0};
    const float r = kShare * in_band_of(material.sheet->reflect, band, bands);
    const float t = kShare * in_band_of(material.sheet->transmit, band, bands);
    return term == 0 ? AnswerToSent{r, t} : AnswerToSent{t, r};
}

AnswerToSent answer_of_medium(double even, float open, double most) {
    const double lit = std::max({static_cast<double>(open), kLeastOpen, most});
    return {static_cast<float>(even * std::numbers::inv_pi / lit), 0};
}

std::uint64_t complete_row(const VolumesBefore& volumes, const formats::Material& material,
                           const RowLayout& layout, const GatherReceiver& receiver,
                           const DenseRow& row) {
    const std::uint32_t n = row.cubemap_size;
    const std::size_t cells = volumes.cells.size();
    std::vector<float> through(volumes.space.extinction_bands() * cells);
    gather_transmittance(volumes.space, volumes.cells, receiver.inside.position, through);
    SentToBoth lit;
    if (volumes.sent != nullptr) {
        lit.front = gather_sent_light(*volumes.sent, receiver.outside);
        if (layout.sheet) {
            lit.back =
                gather_sent_light(*volumes.sent, other_side(receiver.outside, receiver.inside));
        }
    }
    const std::vector<double> solid_angles = formats::texel_solid_angles(n);
    std::vector<double> even;  // of media, term by term
    for (std::uint32_t k = 0; k < row.terms; ++k) {
        for (std::uint32_t band = 0; band < row.bands; ++band) {
            haar_inverse_cube(row.plane(k, band), n);
            even.push_back(even_response(row.plane(k, band), solid_angles));
        }
    }
    const double most =
        std::abs(*std::ranges::max_element(even, {}, [](double value) { return std::abs(value); }));
    for (std::uint32_t k = 0; k < row.terms; ++k) {
        for (std::uint32_t band = 0; band < row.bands; ++band) {
            const std::span<float> texels = row.plane(k, band);
            AnswerToSent answer;
            if (volumes.sent != nullptr) {
                answer = layout.translucent
                             ? answer_of_medium(even[k * row.bands + band], lit.front.open, most)
                             : answer_of_surface(material, k, band, row.bands);
            }
            const float* const share = &through[volumes.space.is_grey ? 0 : band * cells];
            for (std::size_t i = 0; i < texels.size(); ++i) {
                texels[i] *= share[coarser_texel(i, n, volumes.cells.n)];
            }
            if (volumes.sent != nullptr) {
                add_sent_light(*volumes.sent, lit, answer, band, n, texels);
            }
            formats::haar_forward_cube(texels, n);
        }
    }
    return lit.front.rays + lit.back.rays;
}

}  // namespace opaline::bake
