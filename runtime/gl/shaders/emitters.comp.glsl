// Adds the light of one emitter to the products of rows, as runtime/emitter_light.cpp.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Values { uint value_word[]; };  // half floats, 3 a row
layout(std430, binding = 1) buffer Results { vec4 result[]; };

layout(location = 0) uniform uint results;
layout(location = 1) uniform uint value_origin;   // [half floats]
layout(location = 2) uniform uint result_origin;
layout(location = 3) uniform vec3 color;
layout(location = 4) uniform uint is_last;  // nothing comes on top, and rows are a radiance each

float half_float(uint element) {
    vec2 both = unpackHalf2x16(value_word[element >> 1u]);
    return (element & 1u) == 0u ? both.x : both.y;
}

float tame(float value) {
    return value > 0.0 ? min(value, 3.4e38) : 0.0;
}

void main() {
    uint row = gl_GlobalInvocationID.x;
    if (row >= results) return;
    uint at = value_origin + 3u * row;
    vec3 sum = result[result_origin + row].rgb +
               color * vec3(half_float(at), half_float(at + 1u), half_float(at + 2u));
    if (is_last != 0u) {
        sum = vec3(tame(sum.r), tame(sum.g), tame(sum.b));
    }
    result[result_origin + row] = vec4(sum, 0.0);
}
