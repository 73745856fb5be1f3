#include "bake/effects/interreflection/scatterer_light.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/interreflection/even_return.h"
#include "bake/plan/medium_exitance.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCubemap = kBounceCubemap;
constexpr std::size_t kRowTexels = 6 * kCubemap * kCubemap;

BandColour to_bands(formats::Rgb c, std::uint32_t bands) {
    return bands == 1 ? BandColour{formats::luminance(c), 0, 0} : BandColour{c.r, c.g, c.b};
}

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
    std::vector<float> even_sky;  // a light of radiance 1, in the basis of rows
    ScattererLight light;

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

// Sum of the six face averages.
float even_light(std::span<const float> plane) {
    float sum = 0;
    for (std::size_t f = 0; f < plane.size(); f += plane.size() / 6) {
        sum += plane[f];
    }
    return sum;
}

// Of E.
float openness_of(const LitScatterers& field, std::span<const float> row) {
    return std::clamp(static_cast<float>(relit(row, field.even_sky)) / std::numbers::pi_v<float>,
                      0.0f, 1.0f);
}

// B of an opaque or thin-walled surface: rho E. What a lobe mirrors crosses no thin wall.
std::uint64_t light_surface(LitScatterers& field, const DirectionSet& directions, std::size_t i) {
    Scatterer& s = field.scatterers[i];
    std::vector<float> row(kRowTexels), emitted(field.light.row_size());
    formats::Rgb reflect = s.albedo.sum(), transmit{0, 0, 0};
    if (const auto& sheet = field.material(i).sheet) {
        reflect = s.albedo.diffuse * sheet->reflect + s.albedo.mirrored;
        transmit = s.albedo.diffuse * sheet->transmit;
    }
    field.light.reflect[i] = to_bands(reflect, field.light.bands);
    field.light.transmit[i] = to_bands(transmit, field.light.bands);
    std::uint64_t rays = gather_row(field, directions, s.outside, row);
    s.openness = openness_of(field, row);
    add_scaled(row, field.light.reflect[i], field.light.bands, emitted);
    if (field.material(i).sheet) {
        rays += gather_row(field, directions, s.beyond, row);
        field.light.open_beyond[i] = openness_of(field, row);
        add_scaled(row, field.light.transmit[i], field.light.bands, emitted);
    }
    field.light.emitted.set(i, emitted);
    return rays;
}

// What leaves a medium at a point without what its boundary mirrors, under a base colour: c sum of
// g_k T_k.
void add_leaving(const RowLayout& layout, std::span<const float> weight,
                 std::span<const float> rows, const BandColour& colour, std::uint32_t bands,
                 std::span<float> to) {
    const std::uint32_t own_bands = layout.bands();
    for (std::size_t k = 0; k < weight.size(); ++k) {
        for (std::uint32_t b = 0; b < bands; ++b) {
            const std::size_t from = k * own_bands + std::min(b, own_bands - 1);
            for (std::size_t t = 0; t < kRowTexels; ++t) {
                to[b * kRowTexels + t] += colour[b] * weight[k] * rows[from * kRowTexels + t];
            }
        }
    }
}

// B of points of one medium, from the rows that its effects give, without what the boundary mirrors
// (bounce_rays.h); and what they make of bounced light.
std::uint64_t light_medium(LitScatterers& field, const DirectionSet& directions,
                           std::uint32_t material, std::span<const std::size_t> members) {
    constexpr std::size_t kEvenPoints = 256;
    const std::vector<Scatterer> spread = spread_over_material(field.inputs, material, kEvenPoints);
    std::vector<Receiver> outside;
    std::vector<BodyPoint> inside;
    const auto ask_for = [&](const Scatterer& s) {
        outside.push_back(s.outside);
        inside.push_back(s.inside);
    };
    for (const std::size_t i : members) {
        ask_for(field.scatterers[i]);
    }
    std::ranges::for_each(spread, ask_for);
    const std::vector<std::vector<float>> rows =
        field.inputs.rows_of_medium(material, false, outside, inside, kCubemap);
    std::vector<std::vector<float>> crossing;
    if (field.inputs.look_through && field.inputs.look_through(material)) {
        crossing =
            field.inputs.rows_of_medium(material, true, std::span(outside).first(members.size()),
                                        std::span(inside).first(members.size()), kCubemap);
    }
    if (field.inputs.context.cancelled()) return 0;
    const RowLayout& layout = field.inputs.layouts[material];
    const formats::Medium& medium = *field.inputs.bake.scene.materials[material].medium;
    const float eta = medium.eta;
    const std::uint32_t bands = field.light.bands;
    std::uint64_t rays = 0;
    std::vector<float> around(kRowTexels), leaving(field.light.row_size());
    const auto find_leaving = [&](std::size_t m, const BandColour& colour) {
        std::ranges::fill(around, 0.0f);
        std::ranges::fill(leaving, 0.0f);
        rays += gather_row(field, directions, outside[m], around);
        add_leaving(layout, weigh_rows_of_medium(layout, eta, inside[m].normal), rows[m], colour,
                    bands, leaving);
    };
    EvenReturn even(medium);
    for (std::size_t m = members.size(); m < rows.size(); ++m) {
        find_leaving(m, {1, 1, 1});
        BandColour sum{};
        for (std::uint32_t b = 0; b < bands; ++b) {
            sum[b] = even_light(std::span(leaving).subspan(b * kRowTexels, kRowTexels));
        }
        even.add(spread[m - members.size()].position, even_light(around), sum);
    }
    for (std::size_t m = 0; m < members.size(); ++m) {
        const std::size_t i = members[m];
        Scatterer& s = field.scatterers[i];
        const BandColour colour = to_bands(s.albedo.diffuse, bands);
        find_leaving(m, colour);
        if (!crossing.empty()) {
            add_leaving(layout, weigh_rows_of_medium(layout, eta, inside[m].normal), crossing[m],
                        colour, bands, leaving);
        }
        s.openness = openness_of(field, around);
        const BandColour share = even.share(s.position);
        for (std::uint32_t b = 0; b < bands; ++b) {
            field.light.reflect[i][b] = std::clamp(colour[b] * share[b], 0.0f, 1.0f);
        }
        field.light.emitted.set(i, leaving);
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
    for (std::uint32_t m = 0; m < field.inputs.layouts.size(); ++m) {
        std::vector<std::size_t> members;
        for (std::size_t i = 0; i < field.scatterers.size(); ++i) {
            if (field.scatterers[i].material == m && is_inside(i)) {
                members.push_back(i);
            }
        }
        if (!members.empty() && !field.inputs.context.cancelled()) {
            rays += light_medium(field, directions, m, members);
        }
    }
    return rays;
}

}  // namespace

ScattererLight light_scatterers(const LightInputs& inputs, std::span<Scatterer> scatterers,
                                std::uint32_t bands, std::uint64_t& rays) {
    const std::size_t count = scatterers.size();
    LitScatterers field{
        inputs,
        scatterers,
        make_even_sky(),
        {bands, CodedRows(count, bands * kRowTexels), std::vector<BandColour>(count),
         std::vector<BandColour>(count), std::vector<float>(count)}};
    rays += light_all(field);
    return std::move(field.light);
}

}  // namespace opaline::bake
