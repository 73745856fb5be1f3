// A cloud layer, the ground and the sky, as clouds/see_layer.cpp has it, composed with what samples
// see as picture/layer_pass.cpp does: through the corners of pixels, then, where these do not do
// (layer_smooth.frag.glsl), through samples. layer_march.glsl comes before it.
layout(binding = 1) uniform sampler2D samples;
layout(binding = 2) uniform sampler2D depth;    // near / distance along the view axis, 0: nothing
layout(binding = 5) uniform sampler2D albedo_map;
layout(binding = 6) uniform sampler2D ground_light;
layout(binding = 7) uniform sampler2D base_light;

layout(location = 0) uniform vec2 tile_origin;  // [samples] of the picture
layout(location = 1) uniform vec2 to_plane;     // samples to [0, 2] over the picture
layout(location = 2) uniform vec3 right;        // times the half width of the image plane
layout(location = 3) uniform vec3 down;         // times the half height
layout(location = 4) uniform vec3 forward;
layout(location = 13) uniform vec2 albedo_origin;     // the eye's place in the albedo, [0, 1]
layout(location = 14) uniform vec2 light_origin;      // and in the grids of light
layout(location = 15) uniform float eye_above_ground;  // [m]
layout(location = 16) uniform float near_plane;        // [m]
layout(location = 17) uniform int supersampling;
layout(location = 18) uniform int sees_corners;  // 1: of pixels, 0: samples
layout(location = 19) uniform int shows_sky;
layout(location = 0) out vec4 color;
#if SHEET
layout(location = 1) out vec4 sheet_light;    // LayerSheet: radiance, distance
layout(location = 2) out vec4 sheet_through;  // transmittance
#endif

// Bilinear in a level; beyond the edges the same again, or the outermost texels.
vec3 sample_image(sampler2D image, vec2 uv, ivec2 size, int level) {
#if REPEAT
    vec2 at = (uv - floor(uv)) * vec2(size) - 0.5;
    vec2 low = floor(at), t = at - low;
    ivec2 i = ivec2(low), j = i + 1;
    i += size * ivec2(lessThan(i, ivec2(0)));
    j -= size * ivec2(greaterThanEqual(j, size));
    i = min(i, size - 1);
#else
    vec2 at = clamp(uv * vec2(size) - 0.5, vec2(-2.0), vec2(size) + 1.0);
    vec2 low = floor(at), t = at - low;
    ivec2 i = clamp(ivec2(low), ivec2(0), size - 1), j = clamp(ivec2(low) + 1, ivec2(0), size - 1);
#endif
    return mix(mix(texelFetch(image, i, level).rgb, texelFetch(image, ivec2(j.x, i.y), level).rgb, t.x),
               mix(texelFetch(image, ivec2(i.x, j.y), level).rgb, texelFetch(image, j, level).rgb, t.x),
               t.y);
}

vec3 light_at(sampler2D grid, vec2 place) {
    return sample_image(grid, light_origin + place / ground_cell_light.zw, textureSize(grid, 0), 0);
}

vec3 albedo_at(vec2 place, float footprint) {
    vec2 uv = albedo_origin + place / field.xy;
    ivec2 size = field_albedo.zw;
    float at = clamp(log2(max(footprint, 1e-30) / ground_cell_light.x), 0.0, float(levels_counts.y));
    int first = int(at);
    vec3 fine = sample_image(albedo_map, uv, max(size >> first, ivec2(1)), first);
    if (at - float(first) <= 0.0) return fine;
    return mix(fine, sample_image(albedo_map, uv, max(size >> (first + 1), ivec2(1)), first + 1),
               at - float(first));
}

vec3 see_ground(vec2 place, float footprint) {
    vec3 irradiance = light_at(ground_light, place);
    for (int i = 0; i < SUNS; ++i) {
        vec4 shadow = suns[i].shadow;
        float thickness = thickness_at(place + shadow.xy, field_level(max(shadow.z, footprint)));
        irradiance += suns[i].direction_cosine.y * suns[i].irradiance_radius.rgb *
                      kept_share(i, thickness * rest_kappa_peak.rgb);
    }
    return albedo_at(place, footprint) * irradiance / kPi;
}

// `share`: of the view, that the color covers.
vec3 haze_over(vec3 seen, float distance, vec3 share) {
    float taken = taken_share(kappa_haze.a * distance);
    return (1.0 - taken) * seen + taken * share * horizon_luminance.rgb;
}

// The sky and the suns in it.
void see_sky(vec3 world, out vec3 rest, out vec3 sun) {
    vec3 d = light_from_world * world;
    rest = sample_map(d);
    sun = vec3(0.0);
    float luminance = dot(rest, vec3(0.2126, 0.7152, 0.0722));
    if (luminance > horizon_luminance.a && dot(world, map_peak.xyz) > map_peak.w) {
        sun = (1.0 - horizon_luminance.a / luminance) * rest;
    }
    rest -= sun;
    for (int i = 0; i < discs; ++i) {
        if (!is_in_disc(i, d)) continue;
        bool is_sun = i == sun_discs.x || i == sun_discs.y;
        rest += is_sun ? vec3(0.0) : disc_at(i).radiance.rgb;
        sun += is_sun ? disc_at(i).radiance.rgb : vec3(0.0);
    }
}

// Of the slab's own light: single scattering by the normal, all else by +Y.
vec3 slab_source(vec3 direction, vec3 depth, vec2 place, vec3 normal, bool transmitted) {
    float mu_v = clamp(abs(direction.y), kLeastCosine, 1.0);
    vec3 across = crossing_share(depth, mu_v), ground = light_at(base_light, place);
    vec3 ahead = transmitted ? sky_irradiance.rgb : ground;
    vec3 source = (across * ahead + (1.0 - across) * (transmitted ? ground : sky_irradiance.rgb)) / kPi;
    for (int i = 0; i < SUNS; ++i) {
        vec3 l = suns[i].direction_cosine.xyz, single;
        float light = clamp(dot(normal, l), kLeastCosine, 1.0);
        float mu_view = clamp(abs(dot(normal, direction)), kLeastCosine, 1.0);
        for (int b = 0; b < 3; ++b) {
            single[b] = transmitted ? transmitted_source(depth[b], light, mu_view)
                                    : reflected_source(depth[b], light, mu_view);
        }
        vec3 events = peak_weight.rgb / (1.0 - peak_weight.rgb) * depth / mu_view;
        vec3 scattered = single * rest_phase(l, direction, events);
#if MODES > 0
        float horizontal = length(l.xz) * length(direction.xz);
        float cos_azimuth = horizontal > 0.0 ? dot(l.xz, direction.xz) / horizontal : 1.0;
        scattered += multiple_source(i, depth, mu_v, cos_azimuth, transmitted);
#endif
        source += suns[i].irradiance_radius.rgb * scattered;
    }
    return source;
}

float upward_share(vec3 direction) {
    float place = field.w > 0.0 ? clamp(eye_above_base / field.w, 0.0, 1.0) : 0.0;
    float width = 0.6 * place * (1.0 - place);
    if (width <= 0.0) return direction.y >= 0.0 ? 1.0 : 0.0;
    float at = clamp(0.5 + direction.y / (2.0 * width), 0.0, 1.0);
    return at * at * (3.0 - 2.0 * at);
}

vec3 own_source(LayerRay ray, LayerMarch march) {
    vec3 depth = march.thickness * rest_kappa_peak.rgb;
    vec2 place = march.distance * ray.direction.xz;
    float upward = upward_share(ray.direction);
    vec3 source = vec3(0.0);
    for (int side = 0; side < 2; ++side) {
        float share = side == 0 ? upward : 1.0 - upward;
        if (share <= 0.0) continue;
        vec3 normal = vec3(0.0, 1.0, 0.0);
        if (side == 1) {
            vec2 slope = slope_at(place, march.level);
            normal = normalize(vec3(-slope.x, 1.0, -slope.y));
        }
        source += share * slab_source(ray.direction, depth, place, normal, side == 0);
    }
    return source;
}

vec3 glow_along(vec3 direction, vec3 depth) {
    vec3 sum = vec3(0.0);
#if GLOW
    for (int i = 0; i < SUNS; ++i) {
        float angle = scattering_angle(suns[i].direction_cosine.xyz, direction);
        vec3 events = peak_weight.rgb / (1.0 - peak_weight.rgb) * depth, part;
        for (int b = 0; b < 3; ++b) {
            part[b] = exp(-depth[b]) * forward_glow(b, angle, events[b]);
        }
        sum += suns[i].irradiance_radius.rgb * part;
    }
#endif
    return sum;
}

// What a ray sees, and how much of that is the layer.
struct SeenRay {
    vec3 radiance, layer, transmittance;
    float distance;
};

// Along a ray to a surface of that radiance at ray.end, or without end.
SeenRay see_along(LayerRay ray, bool has_surface, vec3 surface) {
    vec3 d = ray.direction, behind = vec3(0.0), sun = vec3(0.0);
    float ground = d.y < 0.0 && eye_above_ground >= 0.0 ? eye_above_ground / -d.y : kNever;
    bool is_opaque = true;
    if (has_surface && ray.end <= 1.001 * ground) {  // kGroundSlack of see_layer.h
        behind = surface;
    } else if (ground < kFarthest) {
        ray.end = ground;
        float footprint = spread * ground / sqrt(max(-d.y, 1e-6));
        behind = haze_over(see_ground(ground * d.xz, footprint), ground, vec3(1.0));
    } else {
        is_opaque = false;
        ray.end = kNever;
        if (shows_sky != 0) see_sky(d, behind, sun);
    }
    LayerMarch march = march_layer(ray, rest_kappa_peak.g);
    if (!(march.length > 0.0)) return SeenRay(behind + sun, vec3(0.0), vec3(1.0), 0.0);
    vec3 depth = march.length * rest_kappa_peak.rgb;
    vec3 share = taken_shares(depth);
    vec3 own = haze_over(share * own_source(ray, march), march.distance, share);
    vec3 seen = own + exp(-depth) * behind;
    if (!is_opaque && shows_sky != 0) {
        seen += glow_along(d, depth) + exp(-march.length * kappa_haze.rgb) * sun;
    }
    return SeenRay(seen, own, exp(-depth), march.distance);
}

// Through the point `at` [samples of the tile], without end.
LayerRay layer_ray(vec2 at, out float cosine) {
    vec2 plane = (tile_origin + at) * to_plane - 1.0;
    vec3 d = plane.x * right + plane.y * down + forward;
    cosine = 1.0 / length(d);
    return LayerRay(d * cosine, near_plane / cosine, kNever);
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    bool at_corner = sees_corners != 0;
    float cosine, inverse = at_corner ? 0.0 : texelFetch(depth, here, 0).r;
    LayerRay ray = layer_ray(at_corner ? vec2(here * supersampling) : gl_FragCoord.xy, cosine);
    vec3 surface = vec3(0.0);
    if (inverse > 0.0) {
        ray.end = near_plane / (inverse * cosine);
        surface = texelFetch(samples, here, 0).rgb;
    }
    SeenRay seen = see_along(ray, inverse > 0.0, surface);
    color = vec4(tame(seen.radiance.r), tame(seen.radiance.g), tame(seen.radiance.b), 1.0);
#if SHEET
    sheet_light = vec4(tame(seen.layer.r), tame(seen.layer.g), tame(seen.layer.b), seen.distance);
    sheet_through = vec4(seen.transmittance, 1.0);
#endif
}
