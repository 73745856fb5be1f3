// What slots show, for the vertices that have them (runtime/embed_gl/spread_batches.h).
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Slots { uint slot[]; };  // of vertices
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
    radiance[radiance_origin + vertex] = shown[shown_origin + slot[slot_origin + vertex]];
}
