// Bilinear or nearest samples of 8-bit images, as runtime/texture.cpp has them. Codes and a table instead of an
// sRGB format: hardware may filter before or after decoding and at its own precision; the CPU decodes
// exactly and filters afterwards.
layout(binding = 7) uniform sampler2D srgb_table;
float linear_from_srgb(uint code) { return texelFetch(srgb_table, ivec2(code, 0), 0).r; }

int wrap_texel(int i, int size, int mode) {
    if (mode == WRAP_CLAMP) return clamp(i, 0, size - 1);
    int period = mode == WRAP_MIRROR ? 2 * size : size;
    i = (i + period) % period;  // i >= -1; of negative numbers GLSL leaves % undefined
    return i < size ? i : period - 1 - i;
}

vec3 image_texel(usampler2D image, ivec2 at, ivec2 wrap, bool is_srgb) {
    ivec2 size = textureSize(image, 0);
    uvec4 code = texelFetch(
        image, ivec2(wrap_texel(at.x, size.x, wrap.x), wrap_texel(at.y, size.y, wrap.y)), 0);
    return is_srgb ? vec3(linear_from_srgb(code.r), linear_from_srgb(code.g),
                          linear_from_srgb(code.b))
                   : vec3(code.rgb) / 255.0;
}

// Keeps the texel number within what an int holds: two periods are as good as any number of them.
// Compares bits: compilers may take numbers for no NaN, and one negated comparison for the other.
float reduce_coordinate(float t, int mode) {
    if ((floatBitsToUint(t) & 0x7fffffffu) >= 0x7149f2cau) {  // 1e30 and all above, infinities, NaN
        return 0.0;
    }
    return mode == WRAP_CLAMP ? clamp(t, -1.0, 2.0) : t - 2.0 * floor(0.5 * t);
}

vec3 sample_image(usampler2D image, vec2 uv, ivec2 wrap, bool is_srgb) {
    bvec2 is_nearest = notEqual(wrap & WRAP_NEAREST, ivec2(0));
    wrap &= ~WRAP_NEAREST;
    vec2 at = vec2(reduce_coordinate(uv.x, wrap.x), reduce_coordinate(uv.y, wrap.y)) *
              vec2(textureSize(image, 0));
    at = mix(at - 0.5, floor(at), is_nearest);
    vec2 low = floor(at), t = at - low;
    ivec2 i = ivec2(low);
    return mix(mix(image_texel(image, i, wrap, is_srgb),
                   image_texel(image, i + ivec2(1, 0), wrap, is_srgb), t.x),
               mix(image_texel(image, i + ivec2(0, 1), wrap, is_srgb),
                   image_texel(image, i + ivec2(1), wrap, is_srgb), t.x), t.y);
}
