#include "runtime/picture/frame_layer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace opaline::runtime {

Camera frame_layer(const formats::LayerRecord& layer, float fov_y, std::uint32_t width,
                   std::uint32_t height) {
    constexpr double kEyeHeight = 1.7, kAzimuth = 30, kUp = 12;  // [m], [degrees]
    const double base = static_cast<double>(layer.base - layer.ground);
    const double eye = std::min(kEyeHeight, base / 2);
    const double farthest = layer.repeats()
                                ? std::numeric_limits<double>::infinity()
                                : static_cast<double>(std::min(layer.size[0], layer.size[1])) / 4;
    const double away = std::min((base - eye) / std::tan(kUp * std::numbers::pi / 180), farthest);
    Camera camera;
    camera.fov_y = fov_y;
    camera.width = width;
    camera.height = height;
    camera.eye = {layer.center[0], layer.ground + static_cast<float>(eye), layer.center[1]};
    const formats::Vec3 back = view_direction(kAzimuth, 0);
    camera.target = {camera.eye.x - static_cast<float>(away) * back.x, layer.base,
                     camera.eye.z - static_cast<float>(away) * back.z};
    camera.near_plane = kLayerNearPlane;
    return camera;
}

}  // namespace opaline::runtime
