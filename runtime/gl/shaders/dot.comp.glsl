// <T_k, L> for the rows of one batch: LANES invocations share a row.
// Specialised by LANES, ROWS (rows of a workgroup), BANDS, CODE_BITS, INDEX_BYTES, and KEEPS_SIGN:
// several terms make a radiance, one may be negative.
layout(local_size_x = LANES, local_size_y = ROWS) in;

// All arrays of the batch in one range: a shader of OpenGL ES may see four buffers.
layout(std430, binding = 0) readonly buffer Transport { uint word[]; };
layout(std430, binding = 1) readonly buffer Light { vec4 light[]; };
layout(std430, binding = 2) writeonly buffer Results { vec4 result[]; };

layout(location = 0) uniform uint results;
layout(location = 1) uniform uint face_texels;
layout(location = 2) uniform uint first_detail;
// Where the batch's arrays begin, counted in elements of their own size; row offsets come first.
layout(location = 3) uniform uint index_origin;
layout(location = 4) uniform uint code_origin;
layout(location = 5) uniform uint average_scale_origin;
layout(location = 6) uniform uint detail_scale_origin;
layout(location = 7) uniform uint average_origin;
layout(location = 8) uniform uint result_origin;

int signed_half(uint element) {
    return bitfieldExtract(int(word[element >> 1u]), int((element & 1u) * 16u), 16);
}

// What a code stands for: of eight bits its square, sign kept.
#if CODE_BITS == 8
int detail_value(uint element) {
    int code = bitfieldExtract(int(word[element >> 2u]), int((element & 3u) * 8u), 8);
    return code * abs(code);
}
#else
int detail_value(uint element) {
    return signed_half(element);
}
#endif

#if INDEX_BYTES == 2
uint detail_index(uint element) {
    return bitfieldExtract(word[element >> 1u], int((element & 1u) * 16u), 16);
}
#else
uint detail_index(uint element) {
    return word[element];
}
#endif

vec3 three_floats(uint at) {
    return uintBitsToFloat(uvec3(word[at], word[at + 1u], word[at + 2u]));
}

// This lane's share of the dot product of row `row`, counted from the batch's first.
vec3 lane_sum(uint row, uint lane) {
    uint begin = word[row] - first_detail;
    uint end = word[row + 1u] - first_detail;
    vec3 details = vec3(0.0);
    for (uint i = begin + lane; i < end; i += uint(LANES)) {
        vec3 l = light[detail_index(index_origin + i)].rgb;
#if BANDS == 1
        details += float(detail_value(code_origin + i)) * l;
#else
        uint at = code_origin + 3u * i;
        details += vec3(detail_value(at), detail_value(at + 1u), detail_value(at + 2u)) * l;
#endif
    }
    vec3 averages = vec3(0.0);
    for (uint face = lane; face < 6u; face += uint(LANES)) {
        vec3 l = light[face * face_texels].rgb;
#if BANDS == 1
        averages += float(signed_half(average_origin + 6u * row + face)) * l;
#else
        uint at = average_origin + 18u * row + face;
        averages += vec3(signed_half(at), signed_half(at + 6u), signed_half(at + 12u)) * l;
#endif
    }
#if BANDS == 1
    float unit = uintBitsToFloat(word[detail_scale_origin + row]);
    float average_unit = uintBitsToFloat(word[average_scale_origin + row]);
#else
    vec3 unit = three_floats(detail_scale_origin + 3u * row);
    vec3 average_unit = three_floats(average_scale_origin + 3u * row);
#endif
    return unit * details + average_unit * averages;
}

#ifdef KEEPS_SIGN
void store(uint row, vec3 sum) {
    result[result_origin + row] = vec4(sum, 0.0);
}
#else
// Truncation rings below zero; radiance does not. NaN fails the comparison and becomes 0.
float tame(float value) {
    return value > 0.0 ? min(value, 3.4e38) : 0.0;
}

void store(uint row, vec3 sum) {
    result[result_origin + row] = vec4(tame(sum.r), tame(sum.g), tame(sum.b), 0.0);
}
#endif

#if LANES == 1
void main() {
    uint row = gl_GlobalInvocationID.y;
    if (row < results) {
        store(row, lane_sum(row, 0u));
    }
}
#else
shared vec3 partial[ROWS][LANES];

void main() {
    uint row = gl_GlobalInvocationID.y, lane = gl_LocalInvocationID.x;
    uint slot = gl_LocalInvocationID.y;
    partial[slot][lane] = row < results ? lane_sum(row, lane) : vec3(0.0);
    for (uint half_lanes = uint(LANES) / 2u; half_lanes > 0u; half_lanes /= 2u) {
        barrier();
        if (lane < half_lanes) {
            partial[slot][lane] += partial[slot][lane + half_lanes];
        }
    }
    if (lane == 0u && row < results) {
        store(row, partial[slot][0]);
    }
}
#endif
