#include "bake/measure/check_multiple.h"

#include <numbers>
#include <vector>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {
namespace {

constexpr double kLuminance[3] = {0.2126, 0.7152, 0.0722};

// Luminance of the row under each light.
std::vector<double> relight_stored(const formats::AssetView& asset,
                                   const formats::PrimitiveRecord& primitive, std::uint32_t row,
                                   std::span<const TestLight> lights) {
    std::vector<double> luminance(lights.size(), 0.0);
    std::vector<float> stored(lights.front().coarse.size());
    for (std::uint32_t band = 0; band < 3; ++band) {
        formats::decode_row(asset.transport, primitive.rows(), row, band, stored);
        for (std::size_t l = 0; l < lights.size(); ++l) {
            double sum = 0;
            for (std::size_t k = 0; k < stored.size(); ++k) {
                sum += static_cast<double>(stored[k]) * static_cast<double>(lights[l].coarse[k]);
            }
            luminance[l] += kLuminance[band] * sum;
        }
    }
    return luminance;
}

}  // namespace

EffectCheck check_multiple(const ClusterTree& tree, const GatherProfile& profile, double exit,
                           const SampleTransport& transport, std::uint32_t material,
                           const formats::AssetView& asset, std::span<const std::uint32_t> drawn,
                           std::span<const TestLight> lights, const Context& context) {
    EffectCheck check{"multiple", "sum over all samples, all coefficients, unquantised", {}, 0};
    const std::size_t nodes = tree.nodes.size();
    for_each_block_in_order(
        drawn.size(), 1, context,
        [&](Range range) {
            std::vector<CheckedPair> pairs;
            const std::uint32_t v = drawn[range.begin];
            const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, v);
            if (primitive.material != material) {
                return pairs;
            }
            const auto to_glm = [](formats::Vec3 a) { return glm::vec3(a.x, a.y, a.z); };
            std::vector<ClusterWeight> weights;
            collect_weights(tree, profile, to_glm(asset.position[v]), to_glm(asset.normal[v]), {0},
                            weights);
            std::vector<double> reference(lights.size(), 0.0);
            for (const ClusterWeight& w : weights) {
                const std::size_t s = w.id - nodes;
                double luminance = 0;
                for (std::size_t band = 0; band < 3; ++band) {
                    luminance += kLuminance[band] * static_cast<double>(w.weight[band]);
                }
                luminance *= static_cast<double>(tree.area[s]) / (std::numbers::pi * exit);
                for (std::size_t l = 0; l < lights.size(); ++l) {
                    reference[l] +=
                        luminance * transport.response[tree.order[s] * lights.size() + l];
                }
            }
            const std::vector<double> stored =
                relight_stored(asset, primitive, v - primitive.first_vertex, lights);
            for (std::size_t l = 0; l < lights.size(); ++l) {
                pairs.push_back({stored[l] - reference[l], reference[l]});
            }
            return pairs;
        },
        [&](Range, const std::vector<CheckedPair>& pairs) {
            check.pairs.insert(check.pairs.end(), pairs.begin(), pairs.end());
        });
    return check;
}

}  // namespace opaline::bake
