// The mean open direction of a receiver from its octahedral axis, two values in [-1, 1], as
// formats/opal/openness.cpp.
vec3 opaline_decode_axis(vec2 p) {
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
    return normalize(vec3(z < 0.0 ? folded : p, z));
}
