// The means of smooth pixels to their samples, and depth 1; other samples stay as they are.
layout(binding = 3) uniform sampler2D means;  // layer_smooth.frag.glsl
layout(location = 0) uniform int supersampling;
layout(location = 0) out vec4 color;

void main() {
    vec4 mean = texelFetch(means, ivec2(gl_FragCoord.xy) / supersampling, 0);
    if (mean.a == 0.0) discard;
    gl_FragDepth = 1.0;
    color = mean;
}
