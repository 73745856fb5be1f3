#include "runtime/clouds/see_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

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

struct Part {
    double begin = 0, end = 0;
};

// Cuts [begin, end] down to where low <= position + t direction <= high.
void cut_to(Part& part, double position, double direction, double low, double high) {
    if (direction == 0) {
        if (position < low || position > high) part.end = part.begin;
        return;
    }
    double in = (low - position) / direction, out = (high - position) / direction;
    if (in > out) std::swap(in, out);
    part.begin = std::max(part.begin, in);
    part.end = std::min(part.end, out);
}

// Where the ray may be inside; empty if end <= begin.
Part part_within(const LayerField& field, const LayerRay& ray) {
    Part part{ray.begin, std::min(ray.end, kFarthest)};
    const double base = static_cast<double>(field.base);
    cut_to(part, static_cast<double>(ray.origin.y), static_cast<double>(ray.direction.y), base,
           base + static_cast<double>(field.highest));
    if (field.repeats()) return part;
    // Coarse levels reach beyond the edge by half a texel.
    const double margin_x = field.size_x / 8, margin_z = field.size_z / 8;
    cut_to(part, static_cast<double>(ray.origin.x), static_cast<double>(ray.direction.x),
           field.low_x - margin_x, field.low_x + field.size_x + margin_x);
    cut_to(part, static_cast<double>(ray.origin.z), static_cast<double>(ray.direction.z),
           field.low_z - margin_z, field.low_z + field.size_z + margin_z);
    return part;
}

// The part of a step that is inside, as shares of it, where the height below the top goes linearly
// from `first` to `last`.
struct Inside {
    float begin = 0, end = 0;
};
Inside inside_of(float first, float last) {
    if (first <= 0 && last <= 0) return {};
    if (first > 0 && last > 0) return {0, 1};
    const float crossing = first / (first - last);
    return first > 0 ? Inside{0, crossing} : Inside{crossing, 1};
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

LayerSheet mean_sheet(std::span<const LayerSheet> sheets) {
    LayerSheet mean{{}, {}, 0};
    float weights = 0;
    for (const LayerSheet& sheet : sheets) {
        const float weight = 1 - sheet.transmittance.g;
        mean.radiance = mean.radiance + sheet.radiance;
        mean.transmittance = mean.transmittance + sheet.transmittance;
        mean.distance += weight * sheet.distance;
        weights += weight;
    }
    const float share = 1 / static_cast<float>(sheets.size());
    mean.radiance = share * mean.radiance;
    mean.transmittance = share * mean.transmittance;
    mean.distance = weights > 0 ? mean.distance / weights : 0;
    return mean;
}

LayerMarch march_layer(const LayerField& field, const LayerRay& ray, float kappa) {
    LayerMarch march;
    const Part part = part_within(field, ray);
    if (!(part.end > part.begin) || !(field.highest > 0)) return march;
    // Distances (begin + offset) ratio^i - offset.
    const double offset = static_cast<double>(field.highest) / 2;
    const double ratio = std::pow((part.end + offset) / (part.begin + offset), 1.0 / kLayerSteps);
    const double level_scale =
        std::hypot(static_cast<double>(ray.direction.x), static_cast<double>(ray.direction.z)) *
        (ratio - 1);
    const double height = static_cast<double>(ray.origin.y) - static_cast<double>(field.base);
    const double climb = static_cast<double>(ray.direction.y);
    const auto level_at = [&](double t) {
        return field.level_of(
            std::max(level_scale * (t + offset), static_cast<double>(ray.spread) * t));
    };
    constexpr float kOpaque = 20;  // optical depth

    double t = part.begin;
    float level = level_at(t);
    float thickness = sample_thickness(field, ray.x(t), ray.z(t), level);
    float below_top = thickness - static_cast<float>(height + climb * t);
    float weights = 0, thickness_sum = 0, level_sum = 0;
    double distance_sum = 0, growth = 1;
    for (int i = 0; i < kLayerSteps && kappa * march.length < kOpaque; ++i) {
        growth *= ratio;
        const double next =
            i + 1 < kLayerSteps ? (part.begin + offset) * growth - offset : part.end;
        const float next_level = level_at(next);
        const float next_thickness = sample_thickness(field, ray.x(next), ray.z(next), next_level);
        const float next_below = next_thickness - static_cast<float>(height + climb * next);
        const Inside inside = inside_of(below_top, next_below);
        if (inside.end > inside.begin) {
            const float length = (inside.end - inside.begin) * static_cast<float>(next - t);
            const float weight = std::exp(-kappa * march.length) * taken_share(kappa * length);
            const float middle = (inside.begin + inside.end) / 2;
            march.length += length;
            weights += weight;
            thickness_sum += weight * (thickness + middle * (next_thickness - thickness));
            level_sum += weight * (level + middle * (next_level - level));
            distance_sum +=
                static_cast<double>(weight) * (t + static_cast<double>(middle) * (next - t));
        }
        t = next;
        level = next_level;
        thickness = next_thickness;
        below_top = next_below;
    }
    if (!(weights > 0)) {
        march.length = 0;
        return march;
    }
    march.distance = distance_sum / static_cast<double>(weights);
    march.thickness = thickness_sum / weights;
    march.level = level_sum / weights;
    return march;
}

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
