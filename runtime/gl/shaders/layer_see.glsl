// What a ray sees of a layer and of the ground, as clouds/see_layer.cpp and clouds/see_ground.cpp
// have it. layer_march.glsl comes before it.
layout(binding = 5) uniform sampler2D albedo_map;
layout(binding = 6) uniform sampler2D ground_light;
layout(binding = 7) uniform sampler2D base_light;

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
    for (int i = 0; i < radiance_counts.z; ++i) {
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

// Of the slab's own light: single scattering by the normal, all else by +Y.
vec3 slab_source(vec3 direction, vec3 depth, vec2 place, vec3 normal, bool transmitted) {
    float mu_v = clamp(abs(direction.y), kLeastCosine, 1.0);
    vec3 across = crossing_share(depth, mu_v), ground = light_at(base_light, place);
    vec3 ahead = transmitted ? sky_irradiance.rgb : ground;
    vec3 source = (across * ahead + (1.0 - across) * (transmitted ? ground : sky_irradiance.rgb)) / kPi;
    for (int i = 0; i < radiance_counts.z; ++i) {
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

float upward_share(LayerRay ray) {
    float height = eye_above_base + ray.from.y;
    float place = field.w > 0.0 ? clamp(height / field.w, 0.0, 1.0) : 0.0;
    float width = 0.6 * place * (1.0 - place);
    if (width <= 0.0) return ray.direction.y >= 0.0 ? 1.0 : 0.0;
    float at = clamp(0.5 + ray.direction.y / (2.0 * width), 0.0, 1.0);
    return at * at * (3.0 - 2.0 * at);
}

vec3 own_source(LayerRay ray, LayerMarch march) {
    vec3 depth = march.thickness * rest_kappa_peak.rgb;
    vec2 place = ray.from.xz + march.distance * ray.direction.xz;
    float upward = upward_share(ray);
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
    for (int i = 0; i < radiance_counts.z; ++i) {
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

// Distance at which a ray meets the ground from above; kNever if it does not.
float ground_distance(vec3 from, vec3 direction) {
    float height = eye_above_ground + from.y;
    return direction.y < 0.0 && height >= 0.0 ? height / -direction.y : kNever;
}

// The ground at that distance, in haze; averaged over the pixel.
vec3 see_ground_along(LayerRay ray, float ground) {
    float footprint = ray.spread * ground / sqrt(max(-ray.direction.y, 1e-6));
    vec2 place = ray.from.xz + ground * ray.direction.xz;
    return haze_over(see_ground(place, footprint), ground, vec3(1.0));
}

// SeenLayer of clouds/see_layer.h.
struct SeenLayer {
    vec3 radiance, glow, transmittance, sun_transmittance;
    float distance;
};

SeenLayer see_layer(LayerRay ray, bool with_glow) {
    LayerMarch march = march_layer(ray, rest_kappa_peak.g);
    if (!(march.length > 0.0)) return SeenLayer(vec3(0.0), vec3(0.0), vec3(1.0), vec3(1.0), 0.0);
    vec3 depth = march.length * rest_kappa_peak.rgb;
    vec3 share = taken_shares(depth);
    vec3 own = haze_over(share * own_source(ray, march), march.distance, share);
    vec3 glow = with_glow ? glow_along(ray.direction, depth) : vec3(0.0);
    return SeenLayer(own, glow, exp(-depth), exp(-march.length * kappa_haze.rgb), march.distance);
}
