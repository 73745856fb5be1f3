#include "bake/effects/interreflection/bounce_light.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "bake/base/ordered_parallel.h"
#include "bake/effects/interreflection/bounce_gather.h"
#include "bake/effects/interreflection/interreflection_knobs.h"
#include "bake/effects/interreflection/site_light.h"
#include "bake/plan/medium_exitance.h"
#include "bake/scattering/fresnel.h"
#include "bake/transport/irradiance_transport.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
namespace {

constexpr std::uint32_t kCubemap = kBounceCubemap;
constexpr std::size_t kTexels = 6 * kCubemap * kCubemap;
constexpr std::uint32_t kMostBounces = 64;
// A bounce of less of the light than this is the last one.
constexpr double kLeastShare = 1e-3;

using Colour = std::array<float, 3>;

Colour to_bands(formats::Rgb c, std::uint32_t bands) {
    return bands == 1 ? Colour{formats::luminance(c), 0, 0} : Colour{c.r, c.g, c.b};
}

std::vector<float> make_even_sky() {
    const std::vector<double> face = formats::texel_solid_angles(kCubemap);
    std::vector<float> light(kTexels);
    for (std::size_t t = 0; t < kTexels; ++t) {
        light[t] = static_cast<float>(face[t % face.size()]);
    }
    formats::haar_forward_cube(std::span<float>(light), kCubemap);
    return light;
}

// Everything about scatterers but their bounced light.
struct Field {
    const LightInputs& inputs;
    std::span<Scatterer> scatterers;
    std::uint32_t bands;
    std::vector<float> emitted;             // B without bounces, scatterer by scatterer
    std::vector<float> even_sky;            // a light of radiance 1, in the basis of rows
    std::vector<Colour> reflect, transmit;  // of bounced light, from this side and the other one

    std::size_t row_size() const { return bands * kTexels; }
    std::span<float> row(std::size_t i) {
        return std::span(emitted).subspan(i * row_size(), row_size());
    }
    const formats::Material& material(std::size_t i) const {
        return inputs.bake.scene.materials[scatterers[i].material];
    }
};

// Light of the environment at a point, E.
std::uint64_t gather_row(const Field& field, const DirectionSet& directions, const Receiver& at,
                         std::span<float> row) {
    const std::uint64_t rays = gather_irradiance(field.inputs.bake.rays, directions, at, row);
    formats::haar_forward_cube(row, kCubemap);
    return rays;
}

void add_scaled(std::span<const float> from, const Colour& factor, std::uint32_t bands,
                std::span<float> to) {
    for (std::size_t b = 0; b < bands; ++b) {
        for (std::size_t k = 0; k < kTexels; ++k) {
            to[b * kTexels + k] += factor[b] * from[k];
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
float openness_of(const Field& field, std::span<const float> row) {
    return std::clamp(static_cast<float>(relit(row, field.even_sky)) / std::numbers::pi_v<float>,
                      0.0f, 1.0f);
}

// B of an opaque or thin-walled surface: rho E.
std::uint64_t light_surface(Field& field, const DirectionSet& directions, std::size_t i) {
    Scatterer& s = field.scatterers[i];
    std::vector<float> row(kTexels);
    formats::Rgb reflect = s.albedo, transmit{0, 0, 0};
    if (const auto& sheet = field.material(i).sheet) {
        reflect = s.albedo * sheet->reflect;
        transmit = s.albedo * sheet->transmit;
    }
    field.reflect[i] = to_bands(reflect, field.bands);
    field.transmit[i] = to_bands(transmit, field.bands);
    std::uint64_t rays = gather_row(field, directions, s.outside, row);
    s.openness = openness_of(field, row);
    add_scaled(row, field.reflect[i], field.bands, field.row(i));
    if (field.material(i).sheet) {
        rays += gather_row(field, directions, s.beyond, row);
        add_scaled(row, field.transmit[i], field.bands, field.row(i));
    }
    return rays;
}

// B of points of one medium, from the rows that its effects give; and what they make of light
// that is even around them, which bounced light is taken for.
std::uint64_t light_medium(Field& field, const DirectionSet& directions, std::uint32_t material,
                           std::span<const std::size_t> members) {
    std::vector<Receiver> outside;
    std::vector<BodyPoint> inside;
    for (const std::size_t i : members) {
        outside.push_back(field.scatterers[i].outside);
        inside.push_back(field.scatterers[i].inside);
    }
    const std::vector<std::vector<float>> rows =
        field.inputs.rows_of_medium(material, outside, inside, kCubemap);
    const RowLayout& layout = field.inputs.layouts[material];
    const float eta = field.inputs.bake.scene.materials[material].medium->eta;
    // What the boundary mirrors goes on as if it were diffuse: where is wrong, how much is right.
    const auto mirrored = static_cast<float>(fresnel_moments(static_cast<double>(eta)).external);
    const std::uint32_t own_bands = layout.bands();
    std::uint64_t rays = 0;
    std::vector<float> around(kTexels);
    for (std::size_t m = 0; m < members.size() && m < rows.size(); ++m) {
        const std::size_t i = members[m];
        Scatterer& s = field.scatterers[i];
        const Colour albedo = to_bands(s.albedo, field.bands);
        const std::vector<float> weight = weigh_rows_of_medium(layout, eta, s.inside.normal);
        for (std::size_t k = 0; k < weight.size(); ++k) {
            for (std::uint32_t b = 0; b < field.bands; ++b) {
                const std::size_t from = k * own_bands + std::min(b, own_bands - 1);
                const float* const plane = &rows[m][from * kTexels];
                float* const to = &field.row(i)[b * kTexels];
                for (std::size_t t = 0; t < kTexels; ++t) {
                    to[t] += albedo[b] * weight[k] * plane[t];
                }
            }
        }
        rays += gather_row(field, directions, s.outside, around);
        add_scaled(around, {mirrored, mirrored, mirrored}, field.bands, field.row(i));
        const float light = even_light(around);
        s.openness = openness_of(field, around);
        for (std::uint32_t b = 0; b < field.bands; ++b) {
            const float out = even_light(field.row(i).subspan(b * kTexels, kTexels));
            field.reflect[i][b] = light > 0 ? std::clamp(out / light, 0.0f, 1.0f) : 0;
        }
    }
    return rays;
}

std::uint64_t light_scatterers(Field& field) {
    const DirectionSet directions = make_direction_set(kCubemap);
    field.emitted.resize(field.scatterers.size() * field.row_size());
    field.reflect.resize(field.scatterers.size());
    field.transmit.resize(field.scatterers.size());
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

// What reaches a scatterer from others, on its side and, through a sheet, on the other one.
struct Arrivals {
    std::vector<NodeWeight> front, back;
};

std::vector<Arrivals> weigh_scatterers(const Field& field, const BounceTree& tree,
                                       std::uint64_t& rays) {
    std::vector<Arrivals> arrivals(field.scatterers.size());
    const BounceGrid grid = make_bounce_grid(kRaysOfScatterer);
    constexpr std::size_t kBlock = 16;
    const auto weigh = [&](const Receiver& at, std::vector<NodeWeight>& weights) {
        return weigh_bounces(field.inputs.bake.scene, field.inputs.bake.rays, tree, at, grid,
                             field.inputs.knobs.seed, weights)
            .rays;
    };
    for_each_block_in_order(
        arrivals.size(), kBlock, field.inputs.context,
        [&](Range range) {
            std::uint64_t traced = 0;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                traced += weigh(field.scatterers[i].outside, arrivals[i].front);
                if (field.material(i).sheet) {
                    traced += weigh(field.scatterers[i].beyond, arrivals[i].back);
                }
            }
            return traced;
        },
        [&](Range, std::uint64_t traced) { rays += traced; });
    return arrivals;
}

double sum_of_even(std::span<const float> rows) {
    double sum = 0;
    for (std::size_t k = 0; k < rows.size(); k += kTexels / 6) {
        sum += static_cast<double>(std::abs(rows[k]));
    }
    return sum;
}

// B = B_0 + rho gather(B), bounce by bounce: the tree's rows become all light that leaves.
std::uint32_t add_bounces(const Field& field, std::span<const Arrivals> arrivals,
                          BounceTree& tree) {
    const std::size_t size = field.row_size();
    std::vector<float> bounced = field.emitted, sum = field.emitted;
    // What neighbours see is mostly the same and still in the cache.
    const std::vector<std::uint32_t> order = tree.neighbours();
    const double all = sum_of_even(sum);
    std::uint32_t bounces = 0;
    while (bounces < kMostBounces && sum_of_even(bounced) > kLeastShare * all &&
           !field.inputs.context.cancelled()) {
        tree.set_rows(bounced);
        constexpr std::size_t kBlock = 64;
        for_each_block_in_order(
            arrivals.size(), kBlock, field.inputs.context,
            [&](Range range) {
                std::vector<float> row(size);
                for (const std::uint32_t i :
                     std::span(order).subspan(range.begin, range.end - range.begin)) {
                    const std::span<float> to = std::span(bounced).subspan(i * size, size);
                    std::ranges::fill(to, 0.0f);
                    for (const bool front : {true, false}) {
                        std::ranges::fill(row, 0.0f);
                        add_node_rows(tree, front ? arrivals[i].front : arrivals[i].back, row);
                        const Colour& share = front ? field.reflect[i] : field.transmit[i];
                        for (std::size_t k = 0; k < size; ++k) {
                            to[k] += share[k / kTexels] * row[k];
                        }
                    }
                }
                return 0;
            },
            [](Range, int) {});
        for (std::size_t k = 0; k < sum.size(); ++k) {
            sum[k] += bounced[k];
        }
        ++bounces;
    }
    tree.set_rows(sum);
    return bounces;
}

}  // namespace

std::uint32_t count_rays_of_site(std::uint32_t of_receiver) {
    constexpr double kShare = 0.25;
    return count_bounce_rays(kShare * of_receiver);
}

std::size_t count_scatterers(const Knobs& knobs) {
    constexpr double kPerRay = 36, kFewest = 1024, kMost = 16384;
    const double rays = count_bounce_rays(knobs[kBounceRays]);
    return static_cast<std::size_t>(std::clamp(kPerRay * rays, kFewest, kMost));
}

std::shared_ptr<const BounceLight> find_bounce_light(const LightInputs& inputs,
                                                     std::uint64_t& rays) {
    const std::uint32_t count = count_bounce_rays(inputs.knobs[kBounceRays]);
    std::vector<Scatterer> scatterers =
        find_scatterers(inputs, count_scatterers(inputs.knobs), rays);
    if (scatterers.empty()) {
        return nullptr;
    }
    const bool is_coloured = std::ranges::any_of(inputs.layouts, &RowLayout::coloured);
    Field field{inputs, scatterers, is_coloured ? 3u : 1u, {}, make_even_sky(), {}, {}};
    rays += light_scatterers(field);
    auto light = std::make_shared<BounceLight>(
        BounceLight{.scene = inputs.bake.scene,
                    .rays = inputs.bake.rays,
                    .cubemap_size = kCubemap,
                    .bands = field.bands,
                    .seed = inputs.knobs.seed,
                    .layouts = {inputs.layouts.begin(), inputs.layouts.end()},
                    .tree = BounceTree(scatterers, inputs.layouts.size(), field.row_size()),
                    .of_site = make_bounce_grid(count_rays_of_site(count)),
                    .of_receiver = make_bounce_grid(count),
                    .of_averaged = make_bounce_grid(kRaysOfAveraged),
                    .sites = {},
                    .site_rows = {}});
    const std::vector<Arrivals> arrivals = weigh_scatterers(field, light->tree, rays);
    light->bounces = add_bounces(field, arrivals, light->tree);
    light_sites(inputs, *light, rays);
    return light;
}

}  // namespace opaline::bake
