#include "bake/measure/check_direct.h"

#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"
#include "bake/measure/true_irradiance.h"
#include "bake/visibility/irradiance_transport.h"

namespace opaline::bake {

EffectCheck check_direct(const RayScene& rays, std::span<const Receiver> receivers,
                         const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                         std::span<const TestLight> lights, const Context& context) {
    constexpr std::uint32_t kRaysPerSun = 16;
    EffectCheck check{
        "direct", "rays to the suns, and to all else four a texel of 6 x 64 x 64", {}, 0};
    const DirectionSet directions = make_direction_set(kTruthCubemap);
    const SunRays suns = make_sun_rays(lights, kRaysPerSun);
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
            if (primitive.shading != formats::Shading::diffuse) {
                return found;
            }
            std::vector<float> stored(lights.front().coarse.size());
            formats::decode_row(asset.transport, primitive.rows(), v - primitive.first_vertex, 0,
                                stored);
            std::vector<double> irradiance(lights.size());
            if (receivers[v].normal != glm::vec3(0)) {
                std::vector<float> dense(lights.front().smooth.size());
                found.rays = gather_irradiance(rays, directions, receivers[v], dense);
                found.rays += add_sun_irradiance(rays, suns, receivers[v], 1, irradiance);
                for (std::size_t l = 0; l < lights.size(); ++l) {
                    irradiance[l] += relit(dense, lights[l].smooth);
                }
            }
            for (std::size_t l = 0; l < lights.size(); ++l) {
                const double reference = irradiance[l] * std::numbers::inv_pi;
                const double error = relit(stored, lights[l].coarse) - reference;
                found.pairs.push_back({{error, error}, reference});
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
