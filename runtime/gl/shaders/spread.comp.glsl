// What slots show, for the vertices that have them (runtime/embed_gl/spread_batches.h). With MIXED each
// vertex has three slots and their weights, in 255ths: SlotMix.
layout(local_size_x = 64) in;

#ifdef MIXED
layout(std430, binding = 0) readonly buffer Slots { uvec4 mixed[]; };  // of vertices
#else
layout(std430, binding = 0) readonly buffer Slots { uint slot[]; };  // of vertices
#endif
layout(std430, binding = 1) readonly buffer Shown { vec4 shown[]; };  // of slots
layout(std430, binding = 2) writeonly buffer Radiance { vec4 radiance[]; };

layout(location = 0) uniform uint vertices;
// Where the batch's data begin in the bound ranges.
layout(location = 1) uniform uint slot_origin;
layout(location = 2) uniform uint shown_origin;  // of slot 0, modulo 2^32
layout(location = 3) uniform uint radiance_origin;

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= vertices) return;
#ifdef MIXED
    uvec4 own = mixed[slot_origin + vertex];
    vec3 weight = vec3(own.w & 255u, (own.w >> 8) & 255u, (own.w >> 16) & 255u) / 255.0;
    vec4 sum = weight.x * shown[shown_origin + own.x];
    if (weight.y > 0.0) sum += weight.y * shown[shown_origin + own.y];
    if (weight.z > 0.0) sum += weight.z * shown[shown_origin + own.z];
    radiance[radiance_origin + vertex] = sum;
#else
    radiance[radiance_origin + vertex] = shown[shown_origin + slot[slot_origin + vertex]];
#endif
}
