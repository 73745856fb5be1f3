#include "bake/effects/interreflection/bounce_gather.h"

#include "bake/effects/interreflection/scatterers.h"

namespace opaline::bake {

std::uint64_t weigh_bounces(const formats::Scene& scene, const RayScene& rays,
                            const BounceTree& tree, const Receiver& at, std::uint32_t count,
                            std::uint64_t seed, std::vector<NodeWeight>& weights, bool nearest) {
    weights.clear();
    const float share = 1 / static_cast<float>(count);
    const std::uint64_t traced = trace_bounces(
        rays, at, count, seed,
        [&](const PacketHits& hits, const RayPacket& packet, std::size_t lane, float cosine) {
            const SeenSide side = side_of_hit(scene, hits, lane);
            if (!side.is_seen) {
                return;
            }
            constexpr float kGrazing = 1e-4f;
            const float t = hits.distance[lane];
            const glm::vec3 y{packet.org_x[lane] + t * packet.dir_x[lane],
                              packet.org_y[lane] + t * packet.dir_y[lane],
                              packet.org_z[lane] + t * packet.dir_z[lane]};
            const float footprint =
                nearest ? 0
                        : std::numbers::pi_v<float> * t * t * share /
                              (std::max(cosine, kGrazing) * std::max(side.cosine, kGrazing));
            const std::uint32_t node =
                tree.find(y, {hits.material[lane], side.behind, side.normal}, footprint);
            if (node != formats::kNone) {
                weights.push_back({node, share});
            }
        });
    std::ranges::sort(weights, {}, &NodeWeight::node);
    std::size_t kept = 0;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        if (kept > 0 && weights[kept - 1].node == weights[i].node) {
            weights[kept - 1].weight += weights[i].weight;
        } else {
            weights[kept++] = weights[i];
        }
    }
    weights.resize(kept);
    return traced;
}

void add_node_rows(const BounceTree& tree, std::span<const NodeWeight> weights,
                   std::span<float> rows) {
    for (const NodeWeight& w : weights) {
        const std::span<const float> row = tree.row(w.node);
        for (std::size_t k = 0; k < rows.size(); ++k) {
            rows[k] += w.weight * row[k];
        }
    }
}

void add_to_finer(std::span<const float> from, std::uint32_t m, std::span<float> to,
                  std::uint32_t n, std::uint32_t bands) {
    // The orthonormal average of a face is n times its mean.
    const float scale = static_cast<float>(n) / static_cast<float>(m);
    const std::size_t faces = 6 * std::size_t{bands};
    for (std::size_t face = 0; face < faces; ++face) {
        for (std::size_t row = 0; row < m; ++row) {
            const float* const a = &from[(face * m + row) * m];
            float* const b = &to[(face * n + row) * n];
            for (std::size_t column = 0; column < m; ++column) {
                b[column] += scale * a[column];
            }
        }
    }
}

}  // namespace opaline::bake
