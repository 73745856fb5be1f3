// <T_k, L> for the rows of one batch: LANES invocations share a row.
// Specialised by LANES, ROWS (rows of a workgroup), BANDS, CODE_BITS, INDEX_BYTES, and KEEPS_SIGN:
// several terms make a radiance, one may be negative.
layout(local_size_x = LANES, local_size_y = ROWS) in;

layout(std430, binding = 0) readonly buffer RowOffsets { uint row_offset[]; };
layout(std430, binding = 1) readonly buffer Indices { uint index_word[]; };
layout(std430, binding = 2) readonly buffer Codes { uint code_word[]; };
layout(std430, binding = 3) readonly buffer AverageScales { float average_scale[]; };
layout(std430, binding = 4) readonly buffer DetailScales { float detail_scale[]; };
layout(std430, binding = 5) readonly buffer AverageCodes { uint average_word[]; };
layout(std430, binding = 6) readonly buffer Light { vec4 light[]; };
layout(std430, binding = 7) writeonly buffer Results { vec4 result[]; };

layout(location = 0) uniform uint results;
layout(location = 1) uniform uint face_texels;
layout(location = 2) uniform uint first_detail;
// Where the batch's data begin in the bound ranges.
layout(location = 3) uniform uint row_origin;
layout(location = 4) uniform uint index_origin;
layout(location = 5) uniform uint code_origin;
layout(location = 6) uniform uint scale_origin;
layout(location = 7) uniform uint average_origin;
layout(location = 8) uniform uint result_origin;

int signed_half(uint word, uint element) {
    return bitfieldExtract(int(word), int((element & 1u) * 16u), 16);
}

int average_code(uint element) {
    return signed_half(average_word[element >> 1u], element);
}

// What a code stands for: of eight bits its square, sign kept.
#if CODE_BITS == 8
int detail_value(uint element) {
    int code = bitfieldExtract(int(code_word[element >> 2u]), int((element & 3u) * 8u), 8);
    return code * abs(code);
}
#else
int detail_value(uint element) {
    return signed_half(code_word[element >> 1u], element);
}
#endif

#if INDEX_BYTES == 2
uint detail_index(uint element) {
    return bitfieldExtract(index_word[element >> 1u], int((element & 1u) * 16u), 16);
}
#else
uint detail_index(uint element) {
    return index_word[element];
}
#endif

// This lane's share of the dot product of row `row`, counted from the batch's first.
vec3 lane_sum(uint row, uint lane) {
    uint begin = row_offset[row_origin + row] - first_detail;
    uint end = row_offset[row_origin + row + 1u] - first_detail;
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
        averages += float(average_code(average_origin + 6u * row + face)) * l;
#else
        uint at = average_origin + 18u * row + face;
        averages += vec3(average_code(at), average_code(at + 6u), average_code(at + 12u)) * l;
#endif
    }
#if BANDS == 1
    uint scale = scale_origin + row;
    return detail_scale[scale] * details + average_scale[scale] * averages;
#else
    uint scale = scale_origin + 3u * row;
    vec3 unit = vec3(detail_scale[scale], detail_scale[scale + 1u], detail_scale[scale + 2u]);
    vec3 average_unit =
        vec3(average_scale[scale], average_scale[scale + 1u], average_scale[scale + 2u]);
    return unit * details + average_unit * averages;
#endif
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
