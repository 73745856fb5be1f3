// Box filter over the S x S samples of a pixel.
layout(binding = 0) uniform sampler2D samples;
layout(location = 0) uniform int supersampling;
layout(location = 0) out vec4 color;

void main() {
    ivec2 first = ivec2(gl_FragCoord.xy) * supersampling;
    vec3 sum = vec3(0.0);
    for (int j = 0; j < supersampling; ++j) {
        for (int i = 0; i < supersampling; ++i) {
            sum += texelFetch(samples, first + ivec2(i, j), 0).rgb;
        }
    }
    color = vec4(sum / float(supersampling * supersampling), 1.0);
}
