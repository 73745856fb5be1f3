#include "bake/measure/check_point.h"

namespace opaline::bake {

std::vector<CheckPoint> make_check_points(const formats::AssetView& asset,
                                          std::span<const Receiver> receivers,
                                          std::span<const BodyPoint> points,
                                          std::span<const std::uint32_t> drawn) {
    std::vector<CheckPoint> checked;
    checked.reserve(drawn.size());
    for (const std::uint32_t v : drawn) {
        const formats::PrimitiveRecord& primitive = formats::primitive_of(asset, v);
        CheckPoint point;
        point.primitive = static_cast<std::uint32_t>(&primitive - asset.primitives.data());
        point.material = points[v].material;
        point.vertex = {v, v, v};
        point.receiver = receivers[v];
        point.body = points[v];
        point.key = v;
        checked.push_back(point);
    }
    return checked;
}

}  // namespace opaline::bake
