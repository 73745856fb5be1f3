#include "bake/measure/check_translucent.h"

#include <optional>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/true_multiple.h"
#include "bake/measure/true_single.h"
#include "runtime/view_terms.h"

namespace opaline::bake {
namespace {

constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};
// Of the surface, for each of the two estimates of a receiver's truth.
constexpr std::uint32_t kPointsPerEstimate = 1024;

// h of each row, toward the normal.
std::vector<float> view_of_rows(const RowLayout& layout, glm::vec3 normal) {
    std::vector<float> h(layout.terms(), 1.0f);
    const std::size_t first = layout.first_single();
    runtime::eval_view_terms({normal.x, normal.y, normal.z}, std::span(h).subspan(first));
    return h;
}

// Seen along the normal: sum over terms of h_k <T_k, L>.
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

}  // namespace

EffectCheck check_translucent(const TranslucentRecipe& recipe, const formats::Scene& scene,
                              const RayScene& rays, std::uint32_t material,
                              std::uint32_t depth_samples, std::span<const BodyPoint> points,
                              const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                              std::span<const TestLight> lights, std::uint64_t seed,
                              const Context& context) {
    constexpr std::uint32_t kRaysPerSun = 4;  // a random point of many
    EffectCheck check;
    std::optional<SurfaceIntegral> multiple;
    std::optional<SingleQuadrature> single;
    const SunRays suns = make_sun_rays(lights, kRaysPerSun);
    const SmoothLights smooth = make_smooth_lights(lights);
    if (recipe.multiple != nullptr) {
        check.effect = "multiple";
        check.reference = "the surface integral by Monte Carlo";
        multiple = make_surface_integral(scene, material, recipe.multiple->medium);
    }
    if (recipe.single != nullptr) {
        single = make_single_quadrature(scene, material, 2 * depth_samples, lights);
        check.effect += check.effect.empty() ? "single" : "+single";
        check.reference +=
            std::string(check.reference.empty() ? "" : ", and ") + "rays to twice as many depths";
    }
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
            if (primitive.material != material) {
                return found;
            }
            TwoEstimates reference{Luminance(lights.size()), Luminance(lights.size())};
            if (multiple) {
                reference =
                    integrate_multiple(*multiple, scene, rays, suns, smooth, points[v].position,
                                       kPointsPerEstimate, seed, v, found.rays);
            }
            if (single && points[v].normal != glm::vec3(0)) {
                const Luminance once = integrate_single(*single, rays, points[v], found.rays);
                for (std::size_t l = 0; l < lights.size(); ++l) {
                    reference.first[l] += once[l];
                    reference.second[l] += once[l];
                }
            }
            const Luminance stored =
                relight_stored(asset, primitive, v - primitive.first_vertex,
                               view_of_rows(recipe.layout, points[v].normal), lights);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                found.pairs.push_back(
                    {{stored[l] - reference.first[l], stored[l] - reference.second[l]},
                     0.5 * (reference.first[l] + reference.second[l])});
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
