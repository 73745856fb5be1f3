// The means of smooth pixels to their samples, and depth 1; other samples stay as they are.
layout(binding = 3) uniform sampler2D means;  // layer_smooth.frag.glsl
layout(location = 0) uniform int supersampling;
layout(location = 0) out vec4 color;
#if SHEET
layout(binding = 8) uniform sampler2D mean_light;
layout(binding = 9) uniform sampler2D mean_through;
layout(location = 1) out vec4 sheet_light;
layout(location = 2) out vec4 sheet_through;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy) / supersampling;
    vec4 mean = texelFetch(means, pixel, 0);
    if (mean.a == 0.0) discard;
    gl_FragDepth = 1.0;
    color = mean;
#if SHEET
    sheet_light = texelFetch(mean_light, pixel, 0);
    sheet_through = texelFetch(mean_through, pixel, 0);
#endif
}
