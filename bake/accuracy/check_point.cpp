#include "bake/accuracy/check_point.h"

#include <bit>

namespace opaline::bake {

std::vector<CheckPoint> make_check_points(std::span<const ReceiverSet> sets,
                                          std::span<const std::uint32_t> drawn) {
    std::vector<CheckPoint> checked;
    checked.reserve(drawn.size());
    for (const std::uint32_t v : drawn) {
        const ReceiverSet& set = set_of(sets, v);
        CheckPoint point;
        point.primitive = set.primitive;
        point.material = set.material;
        point.vertex = {v, v, v};
        point.receiver = set.outside[v - set.first];
        point.body = set.inside[v - set.first];
        point.key = v;
        checked.push_back(point);
    }
    return checked;
}

void turn_thin_walled(const formats::Scene& scene, std::span<CheckPoint> points) {
    for (CheckPoint& point : points) {
        point.behind =
            scene.materials[point.material].sheet.has_value() && std::popcount(point.key) % 2 == 1;
    }
}

}  // namespace opaline::bake
