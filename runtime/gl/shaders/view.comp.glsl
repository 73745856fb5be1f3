// What a vertex of several rows shows the eye, without base colour and Fresnel factor.
// Translucent: view_terms.glsl, which comes before this. SEPARATE: multiple scattering has a row of
// its own before them.
// SHEET, thin-walled (HARMONICS is 0): <T_k, L> of the side that the eye is on.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Products { vec4 product[]; };
vec3 product_at(uint row) { return product[row].rgb; }
layout(std430, binding = 3) writeonly buffer Radiance { vec4 radiance[]; };

layout(location = 0) uniform uint vertices;
// Where the batch's data begin in the bound ranges.
layout(location = 1) uniform uint product_origin;
layout(location = 2) uniform uint radiance_origin;
layout(location = 3) uniform uvec2 shows;  // multiple, single

#if HARMONICS > 1 || defined(SHEET)
layout(std430, binding = 1) readonly buffer Positions { float position[]; };
layout(std430, binding = 2) readonly buffer Normals { float normal[]; };

layout(location = 4) uniform vec3 eye;
layout(location = 5) uniform float unit;  // 1 / distance scale: keeps squares within floats
layout(location = 8) uniform uint point_origin;  // of positions and normals

vec3 normal_of(uint vertex) {
    uint p = point_origin + 3u * vertex;
    return vec3(normal[p], normal[p + 1u], normal[p + 2u]);
}

vec3 from_vertex_to_eye(uint vertex) {
    uint p = point_origin + 3u * vertex;
    return (eye - vec3(position[p], position[p + 1u], position[p + 2u])) * unit;
}
#endif

#if HARMONICS > 1
layout(location = 6) uniform float eta;
layout(location = 7) uniform uint is_double_sided;

vec3 sum_of(uint vertex, uint at) {
    return sum_toward_eye(normal_of(vertex), from_vertex_to_eye(vertex), eta, is_double_sided != 0u,
                          at);
}
#else
vec3 sum_of(uint vertex, uint at) {
    return product_at(at);
}
#endif

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= vertices) return;
    vec3 sum = vec3(0.0);
#ifdef SHEET
    bool is_behind = dot(normal_of(vertex), from_vertex_to_eye(vertex)) < 0.0;
    sum = product_at(product_origin + 2u * vertex + (is_behind ? 1u : 0u));
#elif defined(SEPARATE)
    uint at = product_origin + vertex * (uint(HARMONICS) + 1u);
    if (shows.x != 0u) {
        sum = product_at(at);
    }
    if (shows.y != 0u) {
        sum += sum_of(vertex, at + 1u);
    }
#else
    // Rows that hold both need both.
    if (shows.x != 0u && shows.y != 0u) {
        sum = sum_of(vertex, product_origin + vertex * uint(HARMONICS));
    }
#endif
    radiance[radiance_origin + vertex] = vec4(sum, 0.0);
}
