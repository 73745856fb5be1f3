#include "bake/exchange/scatterer_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/plan/medium_exitance.h"
#include "bake/trace/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCubemap = kBounceCubemap;
constexpr std::size_t kRowTexels = 6 * kCubemap * kCubemap;

std::vector<float> make_even_sky() {
    const std::vector<double> face = formats::texel_solid_angles(kCubemap);
    std::vector<float> light(kRowTexels);
    for (std::size_t t = 0; t < kRowTexels; ++t) {
        light[t] = static_cast<float>(face[t % face.size()]);
    }
    formats::haar_forward_cube(std::span<float>(light), kCubemap);
    return light;
}

struct LitScatterers {
    const LightInputs& inputs;
    std::span<Scatterer> scatterers;
    std::span<const MediumRows> media;  // in the order of the answers
    ScattererLight light;
    std::vector<std::uint32_t> lobe{};  // number_lobes

    const formats::Material& material(std::size_t i) const {
        return inputs.bake.scene.materials[scatterers[i].material];
    }
};

// Light of the environment at a point, E.
std::uint64_t gather_row(const LitScatterers& field, const DirectionSet& directions,
                         const Receiver& at, std::span<float> row) {
    const std::uint64_t rays = gather_irradiance(field.inputs.bake.rays, directions, at, row);
    formats::haar_forward_cube(row, kCubemap);
    return rays;
}

void add_scaled(std::span<const float> from, const BandColour& factor, std::uint32_t bands,
                std::span<float> to) {
    for (std::size_t b = 0; b < bands; ++b) {
        for (std::size_t k = 0; k < kRowTexels; ++k) {
            to[b * kRowTexels + k] += factor[b] * from[k];
        }
    }
}

// Of E.
float openness_of(std::span<const float> row) {
    return std::clamp(even_share(row), 0.0f, 1.0f);
}

// B of an opaque or thin-walled surface: rho E. What a lobe mirrors crosses no thin wall; of a
// narrow one rays follow it (bounce_rays.h), and E is kept.
std::uint64_t light_surface(LitScatterers& field, const DirectionSet& directions, std::size_t i) {
    Scatterer& s = field.scatterers[i];
    std::vector<float> row(kRowTexels), emitted(field.light.row_size());
    formats::Rgb reflect = s.albedo.diffuse + s.albedo.spread(), transmit{0, 0, 0};
    if (const auto& sheet = field.material(i).sheet) {
        reflect = s.albedo.diffuse * sheet->reflect + s.albedo.spread();
        transmit = s.albedo.diffuse * sheet->transmit;
    }
    field.light.answers.reflect[i] = {reflect.r, reflect.g, reflect.b};
    field.light.answers.transmit[i] = {transmit.r, transmit.g, transmit.b};
    std::uint64_t rays = gather_row(field, directions, s.outside, row);
    s.openness = openness_of(row);
    add_scaled(row, in_bands(field.light.answers.reflect[i], field.light.bands), field.light.bands,
               emitted);
    if (field.lobe[i] != formats::kNone) {
        std::vector<float> irradiance(field.light.row_size());
        add_scaled(row, {1, 1, 1}, field.light.bands, irradiance);
        field.light.emitted.set(field.scatterers.size() + field.lobe[i], irradiance);
    }
    if (field.material(i).sheet) {
        rays += gather_row(field, directions, s.beyond, row);
        field.light.open_beyond[i] = openness_of(row);
        add_scaled(row, in_bands(field.light.answers.transmit[i], field.light.bands),
                   field.light.bands, emitted);
    }
    field.light.emitted.set(i, emitted);
    return rays;
}

// What leaves a medium at a point without what its boundary mirrors: sum of g_k T_k.
void add_leaving(const RowLayout& layout, std::span<const float> weight,
                 std::span<const float> rows, std::uint32_t bands, std::span<float> to) {
    const std::uint32_t own_bands = layout.bands();
    for (std::size_t k = 0; k < weight.size(); ++k) {
        for (std::uint32_t b = 0; b < bands; ++b) {
            const std::size_t from = k * own_bands + std::min(b, own_bands - 1);
            for (std::size_t t = 0; t < kRowTexels; ++t) {
                to[b * kRowTexels + t] += weight[k] * rows[from * kRowTexels + t];
            }
        }
    }
}

// Light of the environment at points of one medium; what crosses it straight to them.
std::uint64_t light_medium(LitScatterers& field, const DirectionSet& directions,
                           const MediumAnswer& answer, std::span<const std::vector<float>> crossing,
                           CodedRows& irradiance) {
    const std::span<const std::uint32_t> members = answer.members;
    const std::uint32_t bands = field.light.bands;
    std::uint64_t rays = 0;
    for_each_block_in_order(
        members.size(), 16, field.inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            std::vector<float> row(kRowTexels), planes;
            for (std::size_t m = range.begin; m < range.end; ++m) {
                Scatterer& s = field.scatterers[members[m]];
                std::ranges::fill(row, 0.0f);
                traced += gather_row(field, directions, s.outside, row);
                s.openness = openness_of(row);
                planes.clear();
                for (std::uint32_t b = 0; b < bands; ++b) {
                    planes.insert(planes.end(), row.begin(), row.end());
                }
                irradiance.set(members[m], planes);
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    if (crossing.empty() || field.inputs.context.cancelled()) return rays;
    field.light.crossing.resize(field.scatterers.size());
    std::vector<float> leaving(field.light.row_size());
    for (std::size_t m = 0; m < crossing.size(); ++m) {
        if (crossing[m].empty()) continue;
        const std::uint32_t material = field.scatterers[members[m]].material;
        const RowLayout& layout = field.inputs.layouts[material];
        const float eta = field.inputs.bake.scene.materials[material].medium->eta;
        std::ranges::fill(leaving, 0.0f);
        const glm::vec3 normal = field.scatterers[members[m]].inside.normal;
        add_leaving(layout, weigh_rows_of_medium(layout, eta, normal), crossing[m], bands, leaving);
        field.light.crossing.set(members[m], leaving);
    }
    return rays;
}

// B of media, from what they make of light on each patch; without what boundaries mirror
// (bounce_rays.h).
std::uint64_t light_media(LitScatterers& field, const DirectionSet& directions) {
    if (field.light.answers.media.empty()) return 0;
    CodedRows irradiance(field.scatterers.size(), field.light.row_size());
    std::uint64_t rays = 0;
    for (std::size_t m = 0; m < field.media.size() && !field.inputs.context.cancelled(); ++m) {
        MediumAnswer& answer = field.light.answers.media[m];
        set_shares(field.inputs, field.scatterers, field.media[m].scattered, answer);
        rays += light_medium(field, directions, answer, field.media[m].crossing, irradiance);
        add_answer(answer, field.scatterers, irradiance, field.light.bands, field.inputs.context,
                   field.light.emitted);
    }
    return rays;
}

std::uint64_t light_all(LitScatterers& field) {
    const DirectionSet directions = make_direction_set(kCubemap);
    std::uint64_t rays = 0;
    constexpr std::size_t kBlock = 16;
    const auto is_inside = [&](std::size_t i) {
        return field.inputs.layouts[field.scatterers[i].material].translucent;
    };
    for_each_block_in_order(
        field.scatterers.size(), kBlock, field.inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                traced += is_inside(i) ? 0 : light_surface(field, directions, i);
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    rays += light_media(field, directions);
    return rays;
}

}  // namespace

float even_share(std::span<const float> plane) {
    static const std::vector<float> even_sky = make_even_sky();
    return static_cast<float>(relit(plane, even_sky)) / std::numbers::pi_v<float>;
}

ScattererLight light_scatterers(const LightInputs& inputs, ExchangePoints& points,
                                std::span<const MediumRows> media, std::uint32_t bands,
                                std::uint64_t& rays) {
    const std::size_t count = points.scatterers.size();
    std::vector<std::uint32_t> lobe = number_lobes(points.scatterers);
    const std::size_t rows = count + count_lobes(lobe);
    LitScatterers field{
        inputs,
        points.scatterers,
        media,
        {bands,
         CodedRows(rows, bands * kRowTexels),
         {std::vector<BandColour>(count), std::vector<BandColour>(count), std::move(points.media)},
         std::vector<float>(count),
         CodedRows(0, bands * kRowTexels)},
        std::move(lobe)};
    rays += light_all(field);
    return std::move(field.light);
}

}  // namespace opaline::bake
