#include "bake/measure/check_translucent.h"

#include <numbers>
#include <optional>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "formats/opal/cubemap.h"
#include "formats/opal/haar.h"
#include "runtime/view_terms.h"

namespace opaline::bake {
namespace {

constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};

// Luminance under each light, seen along the normal: sum over terms of h_k <T_k, L>.
using Luminance = std::vector<double>;

// h of each row, toward the normal.
std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal) {
    std::vector<float> h(layout.terms(), 1.0f);
    const std::size_t first = layout.first_single();
    runtime::eval_view_terms({normal.x, normal.y, normal.z}, std::span(h).subspan(first));
    return h;
}

Luminance relight_stored(const formats::AssetView& asset, const formats::PrimitiveRecord& primitive,
                         std::uint32_t vertex, std::span<const float> h,
                         std::span<const TestLight> lights) {
    Luminance luminance(lights.size(), 0.0);
    std::vector<float> stored(lights.front().coarse.size());
    for (std::uint32_t k = 0; k < primitive.terms; ++k) {
        for (std::uint32_t band = 0; band < 3; ++band) {
            formats::decode_row(asset.transport, primitive.rows(), vertex * primitive.terms + k,
                                band, stored);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                luminance[l] +=
                    static_cast<double>(h[k]) * kLuminance[band] * relit(stored, lights[l].coarse);
            }
        }
    }
    return luminance;
}

void add_multiple(const MultipleStage& stage, const BodyPoint& point, Luminance& luminance) {
    const std::size_t nodes = stage.tree.nodes.size(), lights = luminance.size();
    std::vector<ClusterWeight> weights;
    collect_weights(stage.tree, stage.profile, point.position, point.normal, {0}, weights);
    for (const ClusterWeight& w : weights) {
        const std::size_t s = w.id - nodes;
        double weight = 0;
        for (std::size_t band = 0; band < 3; ++band) {
            weight += kLuminance[band] * static_cast<double>(w.weight[band]);
        }
        weight *= static_cast<double>(stage.tree.area[s]) / (std::numbers::pi * stage.medium.exit);
        for (std::size_t l = 0; l < lights; ++l) {
            luminance[l] += weight * stage.transport.response[stage.tree.order[s] * lights + l];
        }
    }
}

struct SingleReference {
    SingleMedium medium;
    DirectionSet directions;
    std::vector<RayPacket::Lane> shares;
};

std::uint64_t add_single(const SingleReference& reference, const RayScene& rays,
                         const BodyPoint& point, std::span<const float> h,
                         std::span<const TestLight> lights, Luminance& luminance) {
    const std::uint32_t n = reference.directions.cubemap_size;
    const std::size_t size = formats::cubemap_texels(n);
    std::vector<float> row(3 * reference.medium.phase.count() * size);
    const EntryCounts counts =
        gather_single(rays, reference.directions, reference.shares, reference.medium, point, row);
    for (std::size_t plane = 0; plane < row.size() / size; ++plane) {
        const std::span<float> own = std::span(row).subspan(plane * size, size);
        formats::haar_forward_cube(own, n);
        const double weight = static_cast<double>(h[plane / 3]) * kLuminance[plane % 3];
        for (std::size_t l = 0; l < lights.size(); ++l) {
            luminance[l] += weight * relit(own, lights[l].coarse);
        }
    }
    return counts.rays;
}

}  // namespace

EffectCheck check_translucent(const TranslucentRecipe& recipe, const formats::Scene& scene,
                              const RayScene& rays, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const BodyPoint> points,
                              const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                              std::span<const TestLight> lights, const Context& context) {
    EffectCheck check;
    std::optional<SingleReference> single;
    if (recipe.multiple != nullptr) {
        check.effect = "multiple";
        check.reference = "sum over all samples, all coefficients, unquantised";
    }
    if (recipe.single != nullptr) {
        const DirectionSet directions = make_direction_set(asset.cubemap_size);
        single = {
            make_single_medium(scene, material, 2 * depth_samples, recipe.single->medium.phase),
            directions, texel_shares(directions)};
        check.effect += check.effect.empty() ? "single" : "+single";
        check.reference += std::string(check.reference.empty() ? "" : ", and ") +
                           "rays to twice as many depths, four per texel";
    }
    const std::size_t step = single ? 4 : 1;
    struct Found {
        std::vector<CheckedPair> pairs;
        std::uint64_t rays = 0;
    };
    for_each_block_in_order(
        drawn.size(), 1, context,
        [&](Range range) {
            Found found;
            const std::uint32_t v = drawn[range.begin];
            const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, v);
            if (primitive.material != material || range.begin % step != 0) {
                return found;
            }
            const std::vector<float> h = view_of_rows(recipe.layout, points[v].normal);
            Luminance reference(lights.size(), 0.0);
            if (recipe.multiple != nullptr) {
                add_multiple(*recipe.multiple, points[v], reference);
            }
            if (single) {
                found.rays = add_single(*single, rays, points[v],
                                        std::span(h).subspan(recipe.layout.first_single()), lights,
                                        reference);
            }
            const Luminance stored =
                relight_stored(asset, primitive, v - primitive.first_vertex, h, lights);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                found.pairs.push_back({stored[l] - reference[l], reference[l]});
            }
            return found;
        },
        [&](Range, const Found& found) {
            check.pairs.insert(check.pairs.end(), found.pairs.begin(), found.pairs.end());
            check.rays += found.rays;
        });
    return check;
}

}  // namespace opaline::bake
