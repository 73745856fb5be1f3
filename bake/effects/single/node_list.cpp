#include "bake/effects/single/node_list.h"

#include <algorithm>
#include <array>

#include "bake/base/ordered_parallel.h"

namespace opaline::bake {
namespace {

// The largest Ft J at any angle.
float largest_throughput(const Interface<float>& boundary) {
    float largest = 0;
    constexpr int kSteps = 4096;
    for (int i = 1; i <= kSteps; ++i) {
        const float cosine = static_cast<float>(i) / kSteps;
        largest = std::max(largest, enter(cosine, boundary).throughput);
    }
    constexpr float kBetweenSteps = 1.02f;  // sharp peak at the critical angle
    return kBetweenSteps * largest;
}

// On a crease the path runs along a face of the body, closer than a pixel.
bool on_crease(const BodyPoint& point) {
    constexpr float kAlong = 0.9f;
    const glm::vec3 outward = point.position - point.inner;
    return glm::dot(outward, point.normal) < kAlong * glm::length(outward);
}

void add_node(const InteriorNode& node, glm::vec3 centre, std::uint32_t bands, NodeList& list) {
    list.node.push_back(node);
    list.points.x.push_back(node.position.x - centre.x);
    list.points.y.push_back(node.position.y - centre.y);
    list.points.z.push_back(node.position.z - centre.z);
    for (std::size_t c = 0; c < bands; ++c) {
        list.points.weight[c].push_back(node.weight[c]);
    }
}

void cut_into_blocks(NodeList& list) {
    constexpr std::uint32_t kNodes = 512;  // results of a look-up fit the first-level cache
    const auto receivers = static_cast<std::uint32_t>(list.scale.size());
    for (std::uint32_t begin = 0; begin < receivers;) {
        std::uint32_t end = begin + 1;
        while (end < receivers && list.first[end + 1] - list.first[begin] <= kNodes) {
            ++end;
        }
        list.blocks.push_back({begin, end - begin});
        list.largest_block =
            std::max<std::size_t>(list.largest_block, list.first[end] - list.first[begin]);
        begin = end;
    }
}

}  // namespace

NodeList collect_nodes(const RayScene& rays, const SingleMedium& medium, glm::vec3 centre,
                       std::span<const BodyPoint> points, const Context& context) {
    NodeList list;
    list.throughput = largest_throughput(medium.boundary);
    list.first.push_back(0);
    using Item = std::vector<std::vector<InteriorNode>>;
    constexpr std::size_t kBlock = 256;
    for_each_block_in_order(
        points.size(), kBlock, context,
        [&](Range range) {
            Item item;
            for (std::size_t i = range.begin; i < range.end; ++i) {
                item.push_back(place_interior_nodes(
                    medium, points[i], trace_inward_path(rays, points[i], medium.path_limit)));
            }
            return item;
        },
        [&](Range range, Item&& item) {
            for (std::size_t i = 0; i < item.size(); ++i) {
                const bool crease = on_crease(points[range.begin + i]);
                std::array<float, 3> sum{};
                for (const InteriorNode& node : item[i]) {
                    for (std::size_t c = 0; c < 3; ++c) {
                        sum[c] += node.weight[c];
                    }
                    if (crease || node.shells != 1) {
                        list.hard.push_back(
                            {node, static_cast<std::uint32_t>(range.begin + i), node.shells == 1});
                    } else {
                        add_node(node, centre, medium.bands, list);
                    }
                }
                list.first.push_back(static_cast<std::uint32_t>(list.node.size()));
                const float most = std::max({sum[0], sum[1], sum[2]});
                for (std::size_t k = list.first[range.begin + i]; k < list.node.size(); ++k) {
                    const auto& w = list.node[k].weight;
                    list.points.importance.push_back(most > 0 ? std::max({w[0], w[1], w[2]}) / most
                                                              : 0.0f);
                }
                list.scale.push_back(list.throughput * most);
            }
        });
    cut_into_blocks(list);
    for (std::vector<float>* values :
         {&list.points.x, &list.points.y, &list.points.z, &list.points.weight[0],
          &list.points.weight[1], &list.points.weight[2], &list.points.importance}) {
        values->resize(values->size() + kColumnPadding);
    }
    return list;
}

}  // namespace opaline::bake
