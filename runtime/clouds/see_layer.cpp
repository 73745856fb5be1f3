#include "runtime/clouds/see_layer.h"

#include <algorithm>
#include <cmath>

#include "runtime/clouds/see_ground.h"
#include "runtime/clouds/single_scattering.h"
#include "runtime/clouds/slab_source.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

// Of the view upward: 1 looking up, 0 looking down. Between base and highest top both sides are
// near, and they mix where the ray is nearly level.
float upward_share(const LayerField& field, const LayerRay& ray) {
    const float place = field.highest > 0
                            ? std::clamp((ray.origin.y - field.base) / field.highest, 0.0f, 1.0f)
                            : 0.0f;
    const float width = 0.6f * place * (1 - place);
    if (width <= 0) return ray.direction.y >= 0 ? 1.0f : 0.0f;
    const float at = std::clamp(0.5f + ray.direction.y / (2 * width), 0.0f, 1.0f);
    return at * at * (3 - 2 * at);
}

Rgb own_source(const LayerLight& light, const LayerRay& ray, const LayerMarch& march) {
    SlabView view;
    view.direction = ray.direction;
    view.depth = rest_depths(light, march.thickness);
    view.x = ray.x(march.distance);
    view.z = ray.z(march.distance);
    const float upward = upward_share(light.field, ray);
    if (upward >= 1) return slab_source(light, view, true);
    view.slope = sample_slope(light.field, view.x, view.z, march.level);
    const Rgb above = slab_source(light, view, false);
    return upward > 0 ? upward * slab_source(light, view, true) + (1 - upward) * above : above;
}

// Of both suns, on a ray that goes on into the sky.
Rgb glow_along(const LayerLight& light, const LayerRay& ray, const std::array<float, 3>& depth) {
    Rgb sum;
    for (const LitSun& sun : light.sun) {
        const float angle = scattering_angle(sun.direction, ray.direction);
        std::array<float, 3> glow{};
        for (std::size_t b = 0; b < 3; ++b) {
            const float peak = light.record.band[b].peak_weight;
            glow[b] = std::exp(-depth[b]) * forward_glow(light.tables[b], light.record, angle,
                                                         peak / (1 - peak) * depth[b]);
        }
        sum = sum + sun.irradiance * Rgb{glow[0], glow[1], glow[2]};
    }
    return sum;
}

}  // namespace

double ground_distance(const LayerLight& light, formats::Vec3 origin, formats::Vec3 direction) {
    const double height = static_cast<double>(origin.y - light.record.ground);
    if (!(direction.y < 0) || height < 0) return std::numeric_limits<double>::infinity();
    return height / -static_cast<double>(direction.y);
}

SeenLayer see_layer(const LayerLight& light, const LayerRay& ray) {
    SeenLayer seen;
    const LayerMarch march = march_layer(light.field, ray, light.rest_kappa[1]);
    if (!(march.length > 0)) return seen;
    std::array<float, 3> depth{}, through{}, through_sun{}, taken{};
    for (std::size_t b = 0; b < 3; ++b) {
        depth[b] = light.rest_kappa[b] * march.length;
        through[b] = std::exp(-depth[b]);
        through_sun[b] = std::exp(-light.record.band[b].kappa * march.length);
        taken[b] = taken_share(depth[b]);
    }
    seen.transmittance = {through[0], through[1], through[2]};
    seen.sun_transmittance = {through_sun[0], through_sun[1], through_sun[2]};
    const Rgb share{taken[0], taken[1], taken[2]};
    seen.radiance = haze_over(light, share * own_source(light, ray, march), march.distance, share);
    seen.glow = glow_along(light, ray, depth);
    seen.distance = march.distance;
    return seen;
}

SeenRay see_along(const LayerScene& scene, const LayerRay& ray, const Rgb* surface) {
    const LayerLight& light = scene.light;
    LayerRay cut = ray;
    const double ground = ground_distance(light, ray.origin, ray.direction);
    Rgb behind, sun;
    bool is_opaque = true;
    if (surface != nullptr && ray.end <= kGroundSlack * ground) {
        behind = *surface;
    } else if (ground < kFarthest) {
        cut.end = ground;
        // The mean of both sides of the pixel's image, which is stretched along the view.
        const double side = static_cast<double>(ray.spread) * ground;
        const double footprint =
            side / std::sqrt(std::max(-static_cast<double>(ray.direction.y), 1e-6));
        behind =
            haze_over(light, see_ground(light, ray.x(ground), ray.z(ground), footprint), ground);
    } else {
        is_opaque = false;
        cut.end = std::numeric_limits<double>::infinity();
        if (scene.shows_sky) {
            behind = rest_radiance(light.sky, scene.environment, scene.rotation, ray.direction);
            sun = sun_part(light.sky, scene.environment, scene.rotation, ray.direction);
        }
    }
    const SeenLayer seen = see_layer(light, cut);
    Rgb color = seen.radiance + seen.transmittance * behind;
    if (!is_opaque && scene.shows_sky) {
        color = color + seen.glow + seen.sun_transmittance * sun;
    }
    return {color, {seen.radiance, seen.transmittance, static_cast<float>(seen.distance)}};
}

Rgb see_through_layer(const LayerScene& scene, const LayerRay& ray, const Rgb* surface) {
    return see_along(scene, ray, surface).radiance;
}

}  // namespace opaline::runtime
