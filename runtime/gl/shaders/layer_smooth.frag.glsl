// Pixels whose samples all take the mean of what the corners see, as picture/layer_pass.cpp has it:
// `color` is that mean, its last component 1. Others: 0.
layout(binding = 2) uniform sampler2D depth;    // of samples, 0: nothing
layout(binding = 3) uniform sampler2D corners;  // of pixels
layout(location = 0) uniform vec2 tile_origin;  // [samples] of the picture
layout(location = 1) uniform vec2 to_plane;     // samples to [0, 2] over the picture
layout(location = 2) uniform vec3 right;        // times the half width of the image plane
layout(location = 3) uniform vec3 down;         // times the half height
layout(location = 4) uniform vec3 forward;
layout(location = 5) uniform int supersampling;
layout(location = 6) uniform float tolerance;
layout(location = 7) uniform vec4 suns[2];  // direction, and the chord within which it may matter
layout(location = 0) out vec4 color;
#if SHEET
layout(binding = 8) uniform sampler2D corner_light;    // of the layer, and its distance
layout(binding = 9) uniform sampler2D corner_through;  // its transmittance
layout(location = 1) out vec4 sheet_light;
layout(location = 2) out vec4 sheet_through;

// The mean_sheet of the corners (clouds/layer_sheet.cpp).
void smooth_sheet(ivec2 pixel) {
    vec4 light = vec4(0.0);
    vec3 through = vec3(0.0);
    float weights = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 at = pixel + ivec2(i & 1, i >> 1);
        vec4 corner = texelFetch(corner_light, at, 0);
        vec3 left = texelFetch(corner_through, at, 0).rgb;
        light += vec4(corner.rgb, (1.0 - left.g) * corner.a);
        through += left;
        weights += 1.0 - left.g;
    }
    sheet_light = vec4(0.25 * light.rgb, weights > 0.0 ? light.a / weights : 0.0);
    sheet_through = vec4(0.25 * through, 1.0);
}
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 a = texelFetch(corners, pixel, 0).rgb, b = texelFetch(corners, pixel + ivec2(1, 0), 0).rgb;
    vec3 c = texelFetch(corners, pixel + ivec2(0, 1), 0).rgb, d = texelFetch(corners, pixel + 1, 0).rgb;
    vec3 low = min(min(a, b), min(c, d)), high = max(max(a, b), max(c, d));
    bool is_smooth = !any(greaterThan(high - low, tolerance * high));
    for (int i = 0; i < supersampling * supersampling; ++i) {
        ivec2 at = pixel * supersampling + ivec2(i % supersampling, i / supersampling);
#ifdef FORWARD_DEPTH
        is_smooth = is_smooth && !(texelFetch(depth, at, 0).r < 1.0);
#else
        is_smooth = is_smooth && !(texelFetch(depth, at, 0).r > 0.0);
#endif
    }
    vec2 plane = (tile_origin + gl_FragCoord.xy * float(supersampling)) * to_plane - 1.0;
    vec3 direction = normalize(plane.x * right + plane.y * down + forward);
    is_smooth = is_smooth && length(suns[0].xyz - direction) >= suns[0].w &&
                length(suns[1].xyz - direction) >= suns[1].w;
    color = is_smooth ? vec4(0.25 * (a + b + c + d), 1.0) : vec4(0.0);
#if SHEET
    smooth_sheet(pixel);
#endif
}
