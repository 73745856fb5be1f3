// One of the samples of each pixel, to be added to the others. Values stay in the range of half
// floats; what is cut off is white in the end.
uniform sampler2D sampled;
uniform float gain;
layout(location = 0) out vec4 color;

void main() {
    color = vec4(min(gain * texelFetch(sampled, ivec2(gl_FragCoord.xy), 0).rgb, vec3(7000.0)), 1.0);
}
