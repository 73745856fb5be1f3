// A cloud layer, the ground and the sky, as clouds/see_layer.cpp has it, composed with what samples
// see as picture/layer_pass.cpp does: through the corners of pixels, then, where these do not do
// (layer_smooth.frag.glsl), through samples. environment.glsl and layer_see.glsl come before it.
layout(binding = 1) uniform sampler2D samples;
layout(binding = 2) uniform sampler2D depth;    // near / distance along the view axis, 0: nothing

layout(location = 0) uniform vec2 tile_origin;  // [samples] of the picture
layout(location = 1) uniform vec2 to_plane;     // samples to [0, 2] over the picture
layout(location = 2) uniform vec3 right;        // times the half width of the image plane
layout(location = 3) uniform vec3 down;         // times the half height
layout(location = 4) uniform vec3 forward;
layout(location = 12) uniform float spread;     // of a pixel [rad]
layout(location = 16) uniform float near_plane;        // [m]
layout(location = 17) uniform int supersampling;
layout(location = 18) uniform int sees_corners;  // 1: of pixels, 0: samples
layout(location = 19) uniform int shows_sky;
layout(location = 0) out vec4 color;
#if SHEET
layout(location = 1) out vec4 sheet_light;    // LayerSheet: radiance, distance
layout(location = 2) out vec4 sheet_through;  // transmittance
#endif

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

// What a ray sees, and how much of that is the layer.
struct SeenRay {
    vec3 radiance, layer, transmittance;
    float distance;
};

// Along a ray to a surface of that radiance at ray.end, or without end.
SeenRay see_along(LayerRay ray, bool has_surface, vec3 surface) {
    vec3 d = ray.direction, behind = vec3(0.0), sun = vec3(0.0);
    float ground = ground_distance(ray.from, d);
    bool to_sky = false;
    if (has_surface && ray.end <= 1.001 * ground) {  // kGroundSlack of see_layer.h
        behind = surface;
    } else if (ground < kFarthest) {
        ray.end = ground;
        behind = see_ground_along(ray, ground);
    } else {
        ray.end = kNever;
        to_sky = shows_sky != 0;
        if (to_sky) see_sky(d, behind, sun);
    }
    SeenLayer seen = see_layer(ray, to_sky);
    vec3 all = seen.radiance + seen.transmittance * behind + seen.glow + seen.sun_transmittance * sun;
    return SeenRay(all, seen.radiance, seen.transmittance, seen.distance);
}

// Through the point `at` [samples of the tile], without end.
LayerRay layer_ray(vec2 at, out float cosine) {
    vec2 plane = (tile_origin + at) * to_plane - 1.0;
    vec3 d = plane.x * right + plane.y * down + forward;
    cosine = 1.0 / length(d);
    return LayerRay(vec3(0.0), d * cosine, near_plane / cosine, kNever, spread);
}

void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    bool at_corner = sees_corners != 0;
#ifdef FORWARD_DEPTH
    float inverse = at_corner ? 0.0 : 1.0 - texelFetch(depth, here, 0).r;
#else
    float inverse = at_corner ? 0.0 : texelFetch(depth, here, 0).r;
#endif
    float cosine;
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
