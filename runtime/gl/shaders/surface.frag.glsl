// Outgoing radiance: irradiance transport times base colour, and its image where TEXTURED, and the
// Fresnel transmittance where TRANSLUCENT, and a specular reflection on top where GLOSSY (then
// cube_map.glsl comes before this).
layout(location = 0) in vec3 v_irradiance;
layout(location = 1) in vec3 v_base_color;
layout(location = 0) out vec4 color;
layout(location = 11) uniform float shown;  // 1, or 0: left out

float tame(float value) {
    return value > 0.0 ? min(value, 1e35) : 0.0;
}

#ifdef TEXTURED
layout(location = 2) in vec2 v_texcoord;
// Codes and a table instead of an sRGB format: hardware may filter before or after decoding and at
// its own precision; the CPU decodes exactly and filters afterwards.
layout(binding = 0) uniform usampler2D image;
layout(std430, binding = 0) readonly buffer Decode { float linear_from_srgb[256]; };
layout(location = 8) uniform ivec2 wrap;

int wrap_texel(int i, int size, int mode) {
    if (mode == WRAP_CLAMP) {
        return clamp(i, 0, size - 1);
    }
    int period = mode == WRAP_MIRROR ? 2 * size : size;
    i = (i + period) % period;  // i >= -1; of negative numbers GLSL leaves % undefined
    return i < size ? i : period - 1 - i;
}

vec3 texel(int column, int row, ivec2 size) {
    uvec4 code = texelFetch(image, ivec2(wrap_texel(column, size.x, wrap.x),
                                         wrap_texel(row, size.y, wrap.y)), 0);
    return vec3(linear_from_srgb[code.r], linear_from_srgb[code.g], linear_from_srgb[code.b]);
}

// Keeps the texel number within what an int holds: two periods are as good as any number of them.
float reduce(float t, int mode) {
    if (!(abs(t) < 1e30)) {
        return 0.0;
    }
    return mode == WRAP_CLAMP ? clamp(t, -1.0, 2.0) : t - 2.0 * floor(0.5 * t);
}

vec3 sample_image(vec2 uv) {
    ivec2 size = textureSize(image, 0);
    vec2 at = vec2(reduce(uv.x, wrap.x), reduce(uv.y, wrap.y)) * vec2(size) - 0.5;
    vec2 low = floor(at), t = at - low;
    ivec2 i = ivec2(low);
    return mix(mix(texel(i.x, i.y, size), texel(i.x + 1, i.y, size), t.x),
               mix(texel(i.x, i.y + 1, size), texel(i.x + 1, i.y + 1, size), t.x), t.y);
}
#endif

#ifdef TRANSLUCENT
layout(location = 3) in vec3 v_normal;
layout(location = 4) in vec3 v_to_eye;
layout(location = 9) uniform float eta;
layout(location = 10) uniform uint is_double_sided;

vec3 unit_or_zero(vec3 v) {
    float size = length(v);
    return size > 0.0 ? v / size : vec3(0.0);
}

// As fresnel_transmittance of view_terms.cpp.
float transmittance(float c) {
    c = min(c, 1.0);
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (!(c > 0.0) || !(under_root > 0.0)) {
        return 0.0;
    }
    float behind = sqrt(under_root);
    float s = c + behind, p = eta * eta * c + behind;
    return min(2.0 * c * behind * (1.0 / (s * s) + eta * eta / (p * p)), 1.0);
}
#endif

#ifdef GLOSSY
layout(location = 5) in vec4 v_open;
layout(binding = 1) uniform sampler2DArray mirrored_light;
layout(location = 12) uniform mat3 light_from_world;
layout(location = 13) uniform vec2 lobe;          // cosine and sine of its half angle
layout(location = 14) uniform uint has_specular;  // 0: left out

// The next two as in specular.cpp.
float specular_visibility(vec3 axis, float open, vec3 mirrored) {
    float cosine = sqrt(1.0 - open), sine = sqrt(open);
    float low = cosine * lobe.x - sine * lobe.y, high = cosine * lobe.x + sine * lobe.y;
    float at = high > low ? clamp((dot(axis, mirrored) - low) / (high - low), 0.0, 1.0) : 0.0;
    float fits = min(1.0, (1.0 - cosine) / (1.0 - lobe.x));
    float inside = fits * at * at * (3.0 - 2.0 * at);
    float squared = open * open, fourth = squared * squared;
    return 1.0 - (1.0 - inside) * (1.0 - fourth * fourth);
}

vec3 specular(vec3 n, vec3 w, float cosine, bool is_turned) {
    if (has_specular == 0u || !(dot(n, n) > 0.0) || !(cosine > -0.2)) {
        return vec3(0.0);
    }
    float c = clamp(cosine, 1e-6, 1.0);
    float fade = 1.0 + min(cosine, 0.0) / 0.2;
    vec3 mirrored = unit_or_zero(2.0 * c * n - w);
    if (!(dot(mirrored, mirrored) > 0.0)) {
        return vec3(0.0);
    }
    vec3 axis = unit_or_zero(v_open.xyz);
    if (is_turned) {
        axis -= 2.0 * dot(axis, n) * n;
    }
    float share = fade * (1.0 - transmittance(c)) *
                  specular_visibility(axis, clamp(v_open.w, 0.0, 1.0), mirrored);
    return share * sample_cube(mirrored_light, light_from_world * mirrored);
}
#endif

vec3 tame(vec3 v) {
    return vec3(tame(v.r), tame(v.g), tame(v.b));
}

void main() {
    vec3 radiance = shown * v_irradiance * v_base_color;
#ifdef TEXTURED
    radiance *= sample_image(v_texcoord);
#endif
#ifdef TRANSLUCENT
    vec3 n = unit_or_zero(v_normal), w = unit_or_zero(v_to_eye);
    float c = dot(n, w);
    bool is_turned = c < 0.0 && is_double_sided != 0u;
    if (is_turned) {
        n = -n;
        c = -c;
    }
    radiance *= transmittance(c);
#endif
#ifdef GLOSSY
    radiance = tame(radiance) + specular(n, w, c, is_turned);
#endif
    color = vec4(tame(radiance), 1.0);
}
