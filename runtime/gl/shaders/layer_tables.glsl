// What a layer's droplets do to light, as clouds/layer_tables.cpp and clouds/single_scattering.cpp
// have it. arc_tangent.glsl comes before it.
struct LayerSun {
    vec4 direction_cosine;   // toward it; mu_l
    vec4 irradiance_radius;
    vec4 shadow;             // from the ground to the base along x and z, blur [m]
};
layout(std140) uniform Layer {
    vec4 rest_kappa_peak;    // kappa_S by band [1/m], theta_f [rad]
    vec4 kappa_haze;         // kappa by band, haze [1/m]
    vec4 peak_weight;        // P_f by band
    vec4 peak_square;        // mean square angle of a scattering by the peak, by band [rad^2]
    vec4 field;              // size along x and z, side of a texel, highest [m]
    vec4 ground_cell_light;  // side of a texel of the albedo [m], -, size of the light along x, z
    vec4 sky_irradiance;
    vec4 horizon_luminance;  // radiance near the horizon, luminance where the map's sun begins
    vec4 map_peak;           // direction, cosine of the reach of the map's sun
    ivec4 sun_discs;         // those that are suns, -1: none
    ivec4 field_albedo;      // texels of thickness, of albedo
    ivec4 levels_counts;     // last levels of both, phase angles, glow angles
    ivec4 counts;            // glow events, flux depths, flux cosines
    ivec4 radiance_counts;   // depths, cosines, suns
    ivec4 level_first[4];    // first texel of a level of the thickness
    LayerSun suns[2];
    ivec4 value_first;       // of t_ms, glow; of the flux of suns
    vec2 field_origin, albedo_origin, light_origin;  // the eye's places, in [0, 1]
    float eye_above_base, eye_above_ground;          // [m]
};
// Of 2048 columns. Logarithms of the phase function [angle][band], t_ms [band][depth][cosine], glow
// [band][event][angle].
layout(binding = 10) uniform sampler2D table_values;
// [sun][side][mode][depth][view][band]; and of each sun's flux T_ms, T_1: [sun][depth][band][2]
layout(binding = 11) uniform sampler2D sun_values;
float value_of(sampler2D values, int i) {
    return texelFetch(values, ivec2(i & 2047, i >> 11), 0).r;
}
float log_phase_at(int i) { return value_of(table_values, i); }
float t_ms_at(int i) { return value_of(table_values, value_first.x + i); }
float glow_at(int i) { return value_of(table_values, value_first.y + i); }
float sun_table_at(int i) { return value_of(sun_values, i); }
vec2 sun_flux_at(int i) {
    int at = value_first.z + 2 * i;
    return vec2(value_of(sun_values, at), value_of(sun_values, at + 1));
}

const float kLeastCosine = 1e-3;

// 1 - exp(-x), x >= 0: where that would cancel, its Taylor series.
float taken_share(float x) {
    return x > 0.05 ? 1.0 - exp(-x)
                    : x * (1.0 - x / 2.0 * (1.0 - x / 3.0 * (1.0 - x / 4.0 * (1.0 - x / 5.0))));
}

vec3 taken_shares(vec3 x) {
    return vec3(taken_share(x.r), taken_share(x.g), taken_share(x.b));
}

// (1 - exp(-x)) / x
float mean_of_exponential(float x) {
    return x > 1e-6 ? taken_share(x) / x : 1.0;
}

float reflected_source(float depth, float light, float view) {
    float d = min(depth, 1e6), x = d / view;
    return x < 1e-20 ? 1.0 : light / (light + view) * taken_share(x + d / light) / taken_share(x);
}

float transmitted_source(float depth, float light, float view) {
    float d = min(depth, 1e6), x = d / view, y = d / light;
    return exp(-min(x, y)) * mean_of_exponential(abs(x - y)) / mean_of_exponential(x);
}

// A place on an even axis: its first node and the share of the next.
struct Place {
    int first;
    float share;
};

Place place_on_axis(float fraction, int count) {
    float at = clamp(fraction, 0.0, 1.0) * float(count - 1);
    int first = min(int(at), count - 2);
    return Place(first, at - float(first));
}

Place place_depth(float depth, int count) {
    return place_on_axis(1.0 - 1.0 / (1.0 + depth), count);
}

// s in [0, 1] where s^2 (3 - 2 s) = v, and w = 1 - v: two steps of Newton's from its series.
float inverse_smoothstep(float v, float w) {
    float least = clamp(min(v, w), 0.0, 0.5), a = sqrt(least / 3.0);
    float s = a * (1.0 + a * (1.0 / 3.0 + a * 5.0 / 18.0));
    for (int i = 0; i < 2 && a > 0.0; ++i) {
        s -= (s * s * (3.0 - 2.0 * s) - least) / (6.0 * s * (1.0 - s));
    }
    return v <= w ? s : 1.0 - s;
}

float scattering_angle(vec3 to_sun, vec3 from_eye) {
    return 2.0 * arc_tangent(length(to_sun - from_eye), length(to_sun + from_eye));
}

// Abramowitz and Stegun 7.1.26, off by 1.5e-7.
float error_function(float x) {
    float t = 1.0 / (1.0 + 0.3275911 * abs(x));
    float tail = t * (0.254829592 + t * (-0.284496736 + t * (1.421413741 + t * (-1.453152027 +
                 t * 1.061405429)))) * exp(-x * x);
    return x < 0.0 ? tail - 1.0 : 1.0 - tail;
}

// P_S of light from a sun to the eye, exact near 0 and pi, with the edge at the peak's angle as it
// looks after `events` scatterings by the peak.
vec3 rest_phase(vec3 to_sun, vec3 from_eye, vec3 events) {
    float angle = scattering_angle(to_sun, from_eye), beyond = angle - rest_kappa_peak.a;
    float left = 2.0 * arc_tangent(length(to_sun + from_eye), length(to_sun - from_eye));
    if (beyond < 0.0) left = kPi - rest_kappa_peak.a;
    float place = inverse_smoothstep(max(angle, rest_kappa_peak.a) / kPi, left / kPi);
    Place at = place_on_axis(place, levels_counts.z);
    int i = 3 * at.first;
    vec3 low = vec3(log_phase_at(i), log_phase_at(i + 1), log_phase_at(i + 2));
    vec3 high = vec3(log_phase_at(i + 3), log_phase_at(i + 4), log_phase_at(i + 5));
    vec3 straight = exp(-events), sigma = sqrt(max(events, 1.0) * peak_square.rgb / 2.0), share;
    for (int b = 0; b < 3; ++b) {
        float within = beyond >= 0.0 ? 1.0 : 0.0;
        float blurred = sigma[b] > 0.0
                            ? 0.5 + 0.5 * error_function(beyond / (1.41421356 * sigma[b])) : within;
        share[b] = straight[b] * within + (1.0 - straight[b]) * blurred;
    }
    return share * exp(mix(low, high, at.share)) / (1.0 - peak_weight.rgb);
}

#if GLOW
float forward_glow(int band, float angle, float events) {
    float reach = 4.0 * rest_kappa_peak.a;
    if (!(angle < reach) || events > 12.0) return 0.0;
    int angles = levels_counts.w;
    Place column = place_on_axis(sqrt(angle / reach), angles);
    Place row = place_on_axis(sqrt(events / 12.0), counts.x);
    int i = (band * counts.x + row.first) * angles + column.first;
    return max(0.0, mix(mix(glow_at(i), glow_at(i + 1), column.share),
                        mix(glow_at(i + angles), glow_at(i + angles + 1), column.share), row.share));
}
#endif

// What crosses toward the view's cosine, of what is scattered: (T_ms - T_0) / (1 - T_0), by band.
vec3 crossing_share(vec3 depth, float cosine) {
    Place column = place_on_axis(sqrt(cosine), counts.z);
    vec3 share;
    for (int b = 0; b < 3; ++b) {
        Place row = place_depth(depth[b], counts.y);
        int i = (b * counts.y + row.first) * counts.z + column.first;
        float all = clamp(mix(mix(t_ms_at(i), t_ms_at(i + 1), column.share),
                              mix(t_ms_at(i + counts.z), t_ms_at(i + counts.z + 1), column.share),
                              row.share), 0.0, 1.0);
        float taken = taken_share(depth[b] / cosine);
        share[b] = taken > 0.0 ? clamp(all - (1.0 - taken), 0.0, taken) / taken : 1.0;
    }
    return share;
}

// T_0 + T_1 of a sun's flux.
vec3 kept_share(int sun, vec3 depth) {
    vec3 share;
    for (int b = 0; b < 3; ++b) {
        Place row = place_depth(depth[b], counts.y);
        int i = (sun * counts.y + row.first) * 3 + b;
        vec2 flux = clamp(mix(sun_flux_at(i), sun_flux_at(i + 3), row.share), 0.0, 1.0);
        float x = depth[b] / suns[sun].direction_cosine.w;
        float straight = exp(-x), across = clamp(flux.x - straight, 0.0, taken_share(x));
        share[b] = straight + min(flux.y, across);
    }
    return share;
}

#if MODES > 0
// Light scattered twice or more, over 1 - exp(-X_v), per irradiance facing the sun.
vec3 multiple_source(int sun, vec3 depth, float view, float cos_azimuth, bool transmitted) {
    int depths = radiance_counts.x, cosines = radiance_counts.y;
    Place column = place_on_axis(inverse_smoothstep(view, 1.0 - view), cosines);
    int layer = (sun * 2 + (transmitted ? 1 : 0)) * MODES * depths;
    float light = suns[sun].direction_cosine.w, x = clamp(cos_azimuth, -1.0, 1.0);
    vec3 source;
    for (int b = 0; b < 3; ++b) {
        Place row = place_depth(depth[b], depths);
        float before = x, now = 1.0, sum = 0.0;  // cos(m phi), by Chebyshev's recurrence
        for (int m = 0; m < MODES; ++m) {
            int i = ((layer + m * depths + row.first) * cosines + column.first) * 3 + b;
            int next_row = i + 3 * cosines;
            sum += now * mix(mix(sun_table_at(i), sun_table_at(i + 3), column.share),
                             mix(sun_table_at(next_row), sun_table_at(next_row + 3), column.share),
                             row.share);
            float next = 2.0 * x * now - before;
            before = now;
            now = next;
        }
        source[b] = max(0.0, sum) * reflected_source(depth[b], light, view) / kPi;
    }
    return source;
}
#endif
