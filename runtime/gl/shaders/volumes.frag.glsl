// The box filter (resolve.frag.glsl) for what is seen through volumes, as picture/volume_pass.cpp:
// a pixel is marched once, through its centre, unless one of its samples sees a surface before the
// end of the volumes; then each sample is. volume_march.glsl comes before it.
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

// Spherical harmonics toward the eye, formats/opal/spherical_harmonics.cpp.
void find_harmonics(vec3 w, out float value[HARMONICS]) {
    float x = w.x, y = w.y, z = w.z, xx = x * x, yy = y * y, zz = z * z;
    value[0] = 0.2820947918;
#if HARMONICS >= 4
    value[1] = 0.4886025119 * y;
    value[2] = 0.4886025119 * z;
    value[3] = 0.4886025119 * x;
#endif
#if HARMONICS >= 9
    value[4] = 1.0925484306 * x * y;
    value[5] = 1.0925484306 * y * z;
    value[6] = 0.3153915653 * (3.0 * zz - 1.0);
    value[7] = 1.0925484306 * x * z;
    value[8] = 0.5462742153 * (xx - yy);
#endif
#if HARMONICS >= 16
    value[9] = 0.5900435899 * y * (3.0 * xx - yy);
    value[10] = 2.8906114426 * x * y * z;
    value[11] = 0.4570457995 * y * (5.0 * zz - 1.0);
    value[12] = 0.3731763326 * z * (5.0 * zz - 3.0);
    value[13] = 0.4570457995 * x * (5.0 * zz - 1.0);
    value[14] = 1.4453057213 * z * (xx - yy);
    value[15] = 0.5900435899 * x * (xx - 3.0 * yy);
#endif
#if HARMONICS >= 25
    value[16] = 2.5033429418 * x * y * (xx - yy);
    value[17] = 1.7701307698 * y * z * (3.0 * xx - yy);
    value[18] = 0.9461746958 * x * y * (7.0 * zz - 1.0);
    value[19] = 0.6690465436 * y * z * (7.0 * zz - 3.0);
    value[20] = 0.1057855469 * (zz * (35.0 * zz - 30.0) + 3.0);
    value[21] = 0.6690465436 * x * z * (7.0 * zz - 3.0);
    value[22] = 0.4730873479 * (xx - yy) * (7.0 * zz - 1.0);
    value[23] = 1.7701307698 * x * z * (xx - 3.0 * yy);
    value[24] = 0.6258357354 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy));
#endif
}

// Through the point `at` [samples of the tile], without end; `cosine`: of the angle to the axis.
Ray ray_through(vec2 at, out float cosine) {
    vec2 plane = (tile_origin + at) * to_plane - 1.0;
    vec3 d = plane.x * right + plane.y * down + forward;
    cosine = 1.0 / length(d);
    return Ray(d * cosine, near_plane / cosine, kNever);
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
    Ray front = ray, behind = ray;
    front.end = behind.begin = clamp(sheet.distance, ray.begin, max(ray.begin, ray.end));
    Seen near, far;
    for (int part = 0; part < 2; ++part) {  // a loop: drivers inline a march for each call
        Seen seen = march(part == 0 ? front : behind, harmonic);
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
