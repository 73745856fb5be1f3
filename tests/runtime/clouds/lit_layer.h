#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

#include "formats/opal/clouds.h"
#include "formats/opal/environment.h"
#include "runtime/clouds/layer_light.h"
#include "runtime/clouds/see_layer.h"
#include "tests/support/cloud_layers.h"

namespace opaline::test {

/// A test layer with its light, for rays.
struct LitLayer {
    formats::Clouds clouds;
    formats::Environment environment;
    runtime::Rotation rotation;
    runtime::LayerLight light;

    LitLayer(formats::Clouds made, formats::Environment lit,
             const runtime::LayerLightOptions& options = {})
        : clouds(std::move(made)), environment(std::move(lit)) {
        view = clouds.view();
        light = runtime::light_layers(view, environment, rotation, options);
    }
    LitLayer(const LitLayer&) = delete;
    LitLayer& operator=(const LitLayer&) = delete;

    runtime::LayerScene scene() const { return {light, environment, rotation}; }

  private:
    formats::CloudsView view;
};

/// Radiance 1 from everywhere.
inline formats::Environment white_sky(float radiance = 1) {
    formats::Environment environment;
    environment.width = 32;
    environment.height = 16;
    environment.pixel.assign(std::size_t{32} * 16, {radiance, radiance, radiance});
    return environment;
}

/// Unit, from +X toward +Z by `azimuth`, by the sine of the elevation.
inline formats::Vec3 direction_of(double sine, double azimuth) {
    const double across = std::sqrt(1 - sine * sine);
    return {static_cast<float>(across * std::cos(azimuth)), static_cast<float>(sine),
            static_cast<float>(across * std::sin(azimuth))};
}

/// A black sky with a sun of irradiance 1 facing it.
inline formats::Environment one_sun(double sine, double azimuth = 0,
                                    float angular_radius = 0.005f) {
    formats::Environment environment;
    formats::DistantDisc disc;
    disc.direction = direction_of(sine, azimuth);
    disc.angular_radius = angular_radius;
    const auto radiance = static_cast<float>(1 / formats::disc_solid_angle(angular_radius));
    disc.radiance = {radiance, radiance, radiance};
    environment.discs.push_back(disc);
    return environment;
}

/// Both: an even sky of this radiance, and that sun.
inline formats::Environment sunny_day(float radiance, double sine, double azimuth = 0,
                                      float angular_radius = 0.005f) {
    formats::Environment environment = white_sky(radiance);
    environment.discs = one_sun(sine, azimuth, angular_radius).discs;
    return environment;
}

inline bool is_lit(formats::Rgb color) {
    return std::isfinite(color.r) && std::isfinite(color.g) && std::isfinite(color.b) &&
           color.r >= 0 && color.g >= 0 && color.b >= 0;
}

}  // namespace opaline::test
