#include "bake/receivers/body_points.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace opaline::bake {

std::vector<BodyPoint> make_body_points(const formats::Scene& scene,
                                        std::span<const Receiver> receivers) {
    std::vector<BodyPoint> points;
    points.reserve(receivers.size());
    for (const formats::Primitive& p : scene.primitives) {
        const bool translucent = scene.materials[p.material].medium.has_value();
        for (const glm::vec3& position : p.position) {
            const Receiver& receiver = receivers[points.size()];
            const glm::vec3 clearance = receiver.origin - position;
            points.push_back({position, translucent ? receiver.normal : glm::vec3(0),
                              position - clearance, p.material});
        }
    }
    return points;
}

std::vector<ReceiverSet> make_vertex_sets(const formats::Scene& scene,
                                          std::span<const Receiver> outside,
                                          std::span<const BodyPoint> inside) {
    assert(outside.size() == inside.size());
    std::vector<ReceiverSet> sets;
    std::size_t first = 0;
    for (std::uint32_t p = 0; p < scene.primitives.size(); ++p) {
        const formats::Primitive& primitive = scene.primitives[p];
        const std::size_t count = primitive.position.size();
        ReceiverSet set;
        set.material = primitive.material;
        set.primitive = p;
        set.first = static_cast<std::uint32_t>(first);
        const auto outer = outside.subspan(first, count);
        const auto inner = inside.subspan(first, count);
        set.outside.assign(outer.begin(), outer.end());
        set.inside.assign(inner.begin(), inner.end());
        sets.push_back(std::move(set));
        first += count;
    }
    return sets;
}

const ReceiverSet& set_of(std::span<const ReceiverSet> sets, std::uint32_t receiver) {
    const auto after =
        std::upper_bound(sets.begin(), sets.end(), receiver,
                         [](std::uint32_t r, const ReceiverSet& s) { return r < s.first; });
    // Empty sets begin where the next one does: the last one that begins at or before holds it.
    assert(after != sets.begin());
    return *(after - 1);
}

std::uint32_t count_receivers(std::span<const ReceiverSet> sets) {
    return sets.empty() ? 0 : sets.back().first + static_cast<std::uint32_t>(sets.back().size());
}

}  // namespace opaline::bake
