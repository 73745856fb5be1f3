#include "bake/measure/check_direct.h"

#include <algorithm>
#include <numbers>

#include "bake/base/ordered_parallel.h"
#include "bake/visibility/irradiance_transport.h"
#include "formats/opal/haar.h"

namespace opaline::bake {
EffectCheck check_direct(const RayScene& rays, std::span<const Receiver> receivers,
                         const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                         std::span<const TestLight> lights, const Context& context) {
    EffectCheck check{
        "direct", "dense, unquantised transport at twice the cube map resolution", {}, 0};
    const DirectionSet fine = make_direction_set(2 * asset.cubemap_size);
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
            const std::size_t size = lights.front().coarse.size();
            std::vector<float> stored(size), dense(4 * size);
            formats::decode_row(asset.transport, primitive.rows(), v - primitive.first_vertex, 0,
                                stored);
            found.rays = gather_irradiance(rays, fine, receivers[v], dense);
            formats::haar_forward_cube(std::span<float>(dense), fine.cubemap_size);
            for (const TestLight& light : lights) {
                const double reference = relit(dense, light.fine) * std::numbers::inv_pi;
                found.pairs.push_back({relit(stored, light.coarse) - reference, reference});
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
