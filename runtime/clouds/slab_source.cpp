#include "runtime/clouds/slab_source.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/clouds/layer_tables.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;
using formats::Vec3;

float& band_of(Rgb& color, std::size_t band) {
    return band == 0 ? color.r : band == 1 ? color.g : color.b;
}

// Single scattering takes the normal of the top, that of +Y on the other side.
Rgb single_source(const LayerLight& light, const LitSun& sun, const SlabView& view,
                  bool transmitted) {
    const Vec3 normal =
        transmitted ? Vec3{0, 1, 0} : normalize(Vec3{-view.slope.x, 1, -view.slope.z});
    const float mu_l = std::clamp(dot(normal, sun.direction), kLeastCosine, 1.0f);
    const float mu_v = std::clamp(std::abs(dot(normal, view.direction)), kLeastCosine, 1.0f);
    const float angle = scattering_angle(sun.direction, view.direction);
    const float coordinate = phase_coordinate(std::max(angle, light.record.peak_angle));
    Rgb source;
    for (std::size_t b = 0; b < 3; ++b) {
        const float geometry = transmitted ? transmitted_source(view.depth[b], mu_l, mu_v)
                                           : reflected_source(view.depth[b], mu_l, mu_v);
        const float peak = light.record.band[b].peak_weight;
        const float events = peak / (1 - peak) * view.depth[b] / mu_v;
        band_of(source, b) = geometry * rest_phase(light.tables[b], light.record, b, angle,
                                                   coordinate, events, light.peak_mean_square[b]);
    }
    return sun.irradiance * source;
}

Rgb sun_source(const LayerLight& light, const LitSun& sun, const SlabView& view, float mu_v,
               bool transmitted) {
    const Vec3 l = sun.direction, d = view.direction;
    const float across = std::hypot(l.x, l.z) * std::hypot(d.x, d.z);
    const float cos_azimuth = across > 0 ? (l.x * d.x + l.z * d.z) / across : 1.0f;
    const Rgb multiple =
        multiple_source(sun.table, view.depth, sun.cosine, mu_v, cos_azimuth, transmitted);
    return single_source(light, sun, view, transmitted) + sun.irradiance * multiple;
}

// (1 - e^-d) / d
float mean_of_exponential(float d) {
    return d > 1e-6f ? -std::expm1(-d) / d : 1.0f;
}

// Deeper is as good as endless, and products stay finite.
constexpr float kDeepest = 1e6f;

}  // namespace

float scattering_angle(Vec3 to_sun, Vec3 from_eye) {
    // Light travels along -to_sun and then along -from_eye.
    return 2 * std::atan2(length(to_sun - from_eye), length(to_sun + from_eye));
}

Rgb slab_source(const LayerLight& light, const SlabView& view, bool transmitted) {
    const float mu_v = std::clamp(std::abs(view.direction.y), kLeastCosine, 1.0f);
    Rgb source;
    const Rgb sky = light.sky.irradiance, ground = light.base_light.at(view.x, view.z);
    for (std::size_t b = 0; b < 3; ++b) {
        const FluxShares flux = flux_shares(light.tables[b], light.record, view.depth[b], mu_v);
        const float taken = flux.across + flux.reflected;
        // By reciprocity, shares of light transmitted and reflected toward the eye.
        const float across = taken > 0 ? flux.across / taken : 1.0f;
        Rgb above = sky, below = ground;
        const float from_above = band_of(above, b), from_below = band_of(below, b);
        band_of(source, b) = std::numbers::inv_pi_v<float> *
                             (transmitted ? across * from_above + (1 - across) * from_below
                                          : (1 - across) * from_above + across * from_below);
    }
    for (const LitSun& sun : light.sun) {
        source = source + sun_source(light, sun, view, mu_v, transmitted);
    }
    return source;
}

float taken_share(float depth) {
    return -std::expm1(-depth);
}

float reflected_source(float depth, float light, float view) {
    const float d = std::min(depth, kDeepest);
    const float x = d / view;
    if (x < 1e-30f) return 1;  // nothing there, and its limit
    return light / (light + view) * taken_share(x + d / light) / taken_share(x);
}

float transmitted_source(float depth, float light, float view) {
    const float d = std::min(depth, kDeepest);
    const float x_view = d / view, x_light = d / light;
    return std::exp(-std::min(x_view, x_light)) * mean_of_exponential(std::abs(x_light - x_view)) /
           mean_of_exponential(x_view);
}

}  // namespace opaline::runtime
