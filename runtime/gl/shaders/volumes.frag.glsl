// The box filter (resolve.frag.glsl) for what is seen through volumes, as picture/volume_pass.cpp:
// a pixel is marched once, through its centre, unless one of its samples sees a surface before the
// end of the volumes; then each sample is. volume_march.glsl and harmonics.glsl come before it.
layout(binding = 0) uniform sampler2D samples;
layout(binding = 1) uniform sampler2D depth;  // near / distance along the view axis, 0: nothing
layout(location = 0) uniform int supersampling;
layout(location = 1) uniform vec2 tile_origin;  // [samples] of the picture
layout(location = 2) uniform vec2 to_plane;     // samples to [0, 2] over the picture
layout(location = 3) uniform vec3 right;        // times the half width of the image plane
layout(location = 4) uniform vec3 down;         // times the half height
layout(location = 5) uniform vec3 forward;
layout(location = 6) uniform float near_plane;  // [units]
layout(location = 0) out vec4 color;

// Through the point `at` [samples of the tile], without end; `cosine`: of the angle to the axis.
Ray ray_through(vec2 at, out float cosine) {
    vec2 plane = (tile_origin + at) * to_plane - 1.0;
    vec3 d = plane.x * right + plane.y * down + forward;
    cosine = 1.0 / length(d);
    return Ray(vec3(0.0), d * cosine, near_plane / cosine, kNever);
}

float distance_along(ivec2 at, float cosine) {
#ifdef FORWARD_DEPTH
    float inverse = 1.0 - texelFetch(depth, at, 0).r;
#else
    float inverse = texelFetch(depth, at, 0).r;
#endif
    return inverse > 0.0 ? near_plane / (inverse * cosine) : kNever;
}

#if LAYER
// A cloud layer along each sample's ray (clouds/layer_sheet.h), written by layers.frag.glsl.
layout(binding = 2) uniform sampler2D sheet_light;         // radiance; distance [m]
layout(binding = 3) uniform sampler2D sheet_through;       // transmittance
layout(location = 15) uniform float eye_above_ground;      // [units]
layout(location = 16) uniform float units_of_metre;

struct Sheet {
    vec3 radiance, transmittance;
    float distance;  // [units]
};

Sheet sheet_at(ivec2 at) {
    vec4 light = texelFetch(sheet_light, at, 0);
    return Sheet(light.rgb, texelFetch(sheet_through, at, 0).rgb,
                 min(light.a * units_of_metre, kNever));
}

// A surface at that distance, or the ground.
float opaque_distance(float surface, vec3 direction) {
    float ground = direction.y < 0.0 && eye_above_ground >= 0.0 ? eye_above_ground / -direction.y
                                                                : kNever;
    return surface <= 1.001 * ground ? surface : ground;  // kGroundSlack of see_layer.h
}

// The mean_sheet of a pixel's samples, and whether one march does for all of them on a ray that
// meets volumes between begin and end.
Sheet mean_sheet(ivec2 first, float begin, float end, out bool agree) {
    Sheet mean = Sheet(vec3(0.0), vec3(0.0), 0.0);
    float weights = 0.0, low = end, high = begin, share = 1.0 / float(supersampling * supersampling);
    for (int i = 0; i < supersampling * supersampling; ++i) {
        Sheet sheet = sheet_at(first + ivec2(i % supersampling, i / supersampling));
        float weight = 1.0 - sheet.transmittance.g;
        mean.radiance += share * sheet.radiance;
        mean.transmittance += share * sheet.transmittance;
        mean.distance += weight * sheet.distance;
        weights += weight;
        if (weight > 0.0) {
            low = min(low, clamp(sheet.distance, begin, end));
            high = max(high, clamp(sheet.distance, begin, end));
        }
    }
    mean.distance = weights > 0.0 ? mean.distance / weights : 0.0;
    agree = high - low <= SHEET_TOLERANCE * (end - begin);
    return mean;
}

vec3 see_through(Ray ray, float harmonic[HARMONICS], vec3 color, Sheet sheet) {
    float cut = clamp(sheet.distance, ray.begin, max(ray.begin, ray.end));
    Seen near, far;
    for (int part = 0; part < 2; ++part) {  // a loop: drivers inline a march for each call
        Ray side = ray;
        if (part == 0) side.end = cut;
        else side.begin = cut;
        Seen seen = march(side, harmonic);
        if (part == 0) near = seen;
        else far = seen;
    }
    vec3 rest = sheet.transmittance * far.radiance +
                far.transmittance * max(color - sheet.radiance, 0.0);
    return near.radiance + near.transmittance * (sheet.radiance + rest);
}
#else
vec3 see_through(Ray ray, float harmonic[HARMONICS], vec3 color) {
    Seen seen = march(ray, harmonic);
    return seen.radiance + seen.transmittance * color;
}
#endif

void main() {
    int s = supersampling;
    ivec2 first = ivec2(gl_FragCoord.xy) * s;
    float cosine;
    Ray centre = ray_through(vec2(first) + 0.5 * float(s), cosine);
#if LAYER
    centre.end = opaque_distance(kNever, centre.direction);
#endif
    vec2 span = volumes_span(centre);
    bool is_cut = false;
    vec3 mean = vec3(0.0);
    for (int i = 0; i < s * s; ++i) {
        ivec2 at = first + ivec2(i % s, i / s);
        mean += texelFetch(samples, at, 0).rgb / float(s * s);
        is_cut = is_cut || distance_along(at, cosine) < span.y;
    }
    if (span.y <= centre.begin) {
        color = vec4(mean, 1.0);
        return;
    }
#if LAYER
    bool agree;
    Sheet all = mean_sheet(first, span.x, span.y, agree);
    is_cut = is_cut || !agree;
#endif
    int count = is_cut ? s * s : 1;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < count; ++i) {
        Ray ray = centre;
        vec3 behind = mean;
        ivec2 at = first + ivec2(i % s, i / s);
        if (is_cut) {
            ray = ray_through(vec2(at) + 0.5, cosine);
            ray.end = distance_along(at, cosine);
            behind = texelFetch(samples, at, 0).rgb;
        }
        float harmonic[HARMONICS];
        find_harmonics(-ray.direction, harmonic);
#if LAYER
        Sheet sheet = all;
        if (is_cut) {
            ray.end = opaque_distance(ray.end, ray.direction);
            sheet = sheet_at(at);
        }
        sum += see_through(ray, harmonic, behind, sheet);
#else
        sum += see_through(ray, harmonic, behind);
#endif
    }
    color = vec4(sum / float(count), 1.0);
}
