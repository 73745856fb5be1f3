#include "bake/accuracy/volumes/volume_lights.h"

#include <numbers>

namespace opaline::bake {

formats::Environment make_probe_sun(glm::vec3 direction) {
    constexpr float kRadius = 0.00465f;  // [rad]
    const auto radiance = static_cast<float>(std::numbers::pi / formats::disc_solid_angle(kRadius));
    formats::Environment light;
    light.discs.push_back(
        {{direction.x, direction.y, direction.z}, kRadius, {radiance, radiance, radiance}});
    return light;
}

formats::Environment make_even_light() {
    formats::Environment light;
    light.width = 4;
    light.height = 2;
    light.pixel.assign(std::size_t{light.width} * light.height, {1, 1, 1});
    return light;
}

std::vector<formats::Environment> make_volume_lights(std::span<const VolumeProbe> probes) {
    std::vector<formats::Environment> lights;
    for (const VolumeProbe& probe : probes) {
        lights.push_back(make_probe_sun(probe.sun));
    }
    lights.push_back(make_even_light());
    return lights;
}

}  // namespace opaline::bake
