#include "runtime/clouds/see_ground.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opaline::runtime {

using formats::Rgb;

Rgb ground_albedo(const LayerLight& light, double x, double z, double footprint) {
    const formats::LayerRecord& record = light.record;
    const double size_x = static_cast<double>(record.size[0]);
    const double size_z = static_cast<double>(record.size[1]);
    const double cell = std::max(size_x / record.ground_columns, size_z / record.ground_rows);
    const float level = static_cast<float>(std::log2(std::max(footprint, 1e-30) / cell));
    return sample_pyramid(light.albedo, (x - static_cast<double>(record.center[0])) / size_x + 0.5,
                          (z - static_cast<double>(record.center[1])) / size_z + 0.5, level);
}

Rgb see_ground(const LayerLight& light, double x, double z, double footprint) {
    Rgb irradiance = light.ground_light.at(x, z);
    for (const LitSun& sun : light.sun) {
        irradiance = irradiance +
                     sun.direction.y * sun.irradiance * direct_share(light, sun, x, z, footprint);
    }
    return std::numbers::inv_pi_v<float> * ground_albedo(light, x, z, footprint) * irradiance;
}

Rgb haze_over(const LayerLight& light, Rgb color, double distance, Rgb share) {
    const float depth = static_cast<float>(static_cast<double>(light.record.haze) * distance);
    return std::exp(-depth) * color + -std::expm1(-depth) * share * light.sky.horizon;
}

}  // namespace opaline::runtime
