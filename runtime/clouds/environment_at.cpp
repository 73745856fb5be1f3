#include "runtime/clouds/environment_at.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/parallel.h"

namespace opaline::runtime {
namespace {

using formats::Environment;
using formats::Rgb;
using formats::Vec3;
using std::numbers::pi;

// A part of the map: from one height to another, y = cos of the polar angle, and between azimuths
// atan2(z, x).
struct MapPart {
    double top = 1, bottom = -1, begin = 0, end = 0;

    Vec3 middle() const {
        const double y = 0.5 * (top + bottom), across = std::sqrt(1 - y * y);
        const double phi = 0.5 * (begin + end);
        return {static_cast<float>(across * std::cos(phi)), static_cast<float>(y),
                static_cast<float>(across * std::sin(phi))};
    }
    /// Of equal solid angle: number (i, j) of steps x steps.
    MapPart divide(int steps, int i, int j) const {
        const double height = (bottom - top) / steps, width = (end - begin) / steps;
        return {top + j * height, top + (j + 1) * height, begin + i * width,
                begin + (i + 1) * width};
    }
};

template <class Function>
Rgb mean_over(const MapPart& part, int steps, const Function& f) {
    Rgb sum;
    for (int j = 0; j < steps; ++j) {
        for (int i = 0; i < steps; ++i) {
            sum = sum + f(part.divide(steps, i, j).middle());
        }
    }
    return 1.0f / static_cast<float>(steps * steps) * sum;
}

LayerRay ray_from(Vec3 point, Vec3 direction, float spread) {
    LayerRay ray;
    ray.origin = point;
    ray.direction = direction;
    ray.spread = spread;
    return ray;
}

// Whether light that goes nearly straight on may be seen there: it is not even over a pixel.
bool is_near_sun(const LayerLight& light, Vec3 direction, float pixel) {
    constexpr float kGlowReach = 4;  // peak angles, where the table of glow ends
    return std::ranges::any_of(light.sun, [&](const LitSun& sun) {
        return length(sun.direction - direction) < kGlowReach * light.record.peak_angle + pixel;
    });
}

Rgb see_part(const LayerScene& scene, Vec3 point, const MapPart& part, float pixel) {
    const Vec3 middle = part.middle();
    if (middle.y < 0) return see_through_layer(scene, ray_from(point, middle, pixel));
    constexpr int kSkySteps = 4, kGlowSteps = 4;
    const Rgb sky = mean_over(part, kSkySteps, [&](Vec3 d) {
        return map_rest(scene.light.sky, scene.environment, scene.rotation, d);
    });
    const auto see = [&](Vec3 direction, float spread) {
        const SeenLayer seen = see_layer(scene.light, ray_from(point, direction, spread));
        return seen.radiance + seen.glow + seen.transmittance * sky;
    };
    if (!is_near_sun(scene.light, middle, pixel)) return see(middle, pixel);
    return mean_over(part, kGlowSteps, [&](Vec3 d) { return see(d, pixel / kGlowSteps); });
}

// A light as it is seen from the point: `transmittance` of what the layer leaves.
void add_disc(const LayerScene& scene, Vec3 point, formats::DistantDisc disc,
              Rgb SeenLayer::*transmittance, Environment& local) {
    if (!(disc.direction.y > 0)) return;
    const LayerRay ray = ray_from(point, disc.direction, 2 * disc.angular_radius);
    disc.radiance = see_layer(scene.light, ray).*transmittance * disc.radiance;
    if (formats::luminance(disc.radiance) > 0) local.discs.push_back(disc);
}

void add_discs(const LayerScene& scene, Vec3 point, Environment& local) {
    const SkyLight& sky = scene.light.sky;
    for (const LayerSun& sun : sky.suns) {
        const double area = pi * std::pow(std::sin(static_cast<double>(sun.angular_radius)), 2);
        add_disc(scene, point,
                 {sun.direction, sun.angular_radius, static_cast<float>(1 / area) * sun.irradiance},
                 &SeenLayer::sun_transmittance, local);
    }
    for (std::uint32_t i = 0; i < scene.environment.discs.size(); ++i) {
        if (std::ranges::find(sky.sun_discs, i) != sky.sun_discs.end()) continue;
        formats::DistantDisc disc = scene.environment.discs[i];
        disc.direction = formats::normalize(scene.rotation.world_from_light(disc.direction));
        add_disc(scene, point, disc, &SeenLayer::transmittance, local);
    }
}

}  // namespace

Environment environment_at(const LayerScene& scene, Vec3 point,
                           const EnvironmentAtOptions& options) {
    point.y = std::max(point.y, scene.light.record.ground +
                                    1e-4f * (scene.light.record.base - scene.light.record.ground));
    Environment local;
    local.width = options.width;
    local.height = options.height;
    local.pixel.resize(std::size_t{local.width} * local.height);
    const auto pixel = static_cast<float>(pi / local.height);
    for_ranges(local.height, 1, options.threads, [&](std::uint32_t first, std::uint32_t end) {
        for (std::uint32_t row = first; row < end; ++row) {
            const double top = std::cos(pi * row / local.height);
            const double bottom = std::cos(pi * (row + 1) / local.height);
            for (std::uint32_t column = 0; column < local.width; ++column) {
                // The centre of the map is +X.
                const double step = 2 * pi / local.width, begin = column * step - pi;
                local.pixel[std::size_t{row} * local.width + column] =
                    see_part(scene, point, {top, bottom, begin, begin + step}, pixel);
            }
        }
    });
    add_discs(scene, point, local);
    return local;
}

}  // namespace opaline::runtime
