// From radiance to the screen: exposure, tone map, sRGB, as runtime/picture/tone_map.cpp. Row 0 of the picture is its
// top.
uniform sampler2D picture;
uniform float gain;
uniform vec2 scale;  // texels of the picture a pixel of the target
uniform int rows;    // of the target; 0: it is not turned over
layout(location = 0) out vec4 color;

vec3 tone_map(vec3 c) {
    float least = min(c.r, min(c.g, c.b));
    c -= least < 0.08 ? least - least * least / 0.16 : 0.04;
    float peak = max(c.r, max(c.g, c.b));
    if (peak <= 0.76) return c;
    vec3 compressed = mix(c, 1.0 - 0.24 * 0.24 / (max(c, 0.76) + 0.24 - 0.76), greaterThan(c, vec3(0.76)));
    float new_peak = max(compressed.r, max(compressed.g, compressed.b));
    float keep = 1.0 / (0.15 * (peak - new_peak) + 1.0);
    return clamp(new_peak + keep * (compressed - new_peak), 0.0, 1.0);
}

float encode(float linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * pow(linear, 1.0 / 2.4) - 0.055;
}

void main() {
    vec2 at = gl_FragCoord.xy;
    if (rows > 0) at.y = float(rows) - at.y;
    vec3 c = tone_map(min(gain * texelFetch(picture, ivec2(at * scale), 0).rgb, vec3(1e30)));
    color = vec4(encode(c.r), encode(c.g), encode(c.b), 1.0);
}
