// Outgoing radiance: irradiance transport times base colour, and its image where TEXTURED, and the
// Fresnel transmittance where TRANSLUCENT.
layout(location = 0) in vec3 v_irradiance;
layout(location = 1) in vec3 v_base_color;
layout(location = 2) in vec2 v_texcoord;
layout(location = 0) out vec4 color;

float tame(float value) {
    return value > 0.0 ? min(value, 1e35) : 0.0;
}

#ifdef TEXTURED
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
float transmittance() {
    float c = dot(unit_or_zero(v_normal), unit_or_zero(v_to_eye));
    c = min(is_double_sided != 0u ? abs(c) : c, 1.0);
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (!(c > 0.0) || !(under_root > 0.0)) {
        return 0.0;
    }
    float behind = sqrt(under_root);
    float s = c + behind, p = eta * eta * c + behind;
    return min(2.0 * c * behind * (1.0 / (s * s) + eta * eta / (p * p)), 1.0);
}
#endif

void main() {
    vec3 radiance = v_irradiance * v_base_color;
#ifdef TEXTURED
    radiance *= sample_image(v_texcoord);
#endif
#ifdef TRANSLUCENT
    radiance *= transmittance();
#endif
    color = vec4(tame(radiance.r), tame(radiance.g), tame(radiance.b), 1.0);
}
