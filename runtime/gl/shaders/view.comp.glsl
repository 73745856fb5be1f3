// What a vertex of several rows shows the eye, without base colour and Fresnel factor.
// Translucent: sum_k h_k(w_o') <T_k, L>, the same steps as view_terms.cpp. Specialised by HARMONICS,
// the rows of a vertex that the direction to the eye weighs, 1, 4, 9, 16 or 25, and SEPARATE:
// multiple scattering has a row of its own before them.
// SHEET, thin-walled (HARMONICS is 0): <T_k, L> of the side that the eye is on.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Products { vec4 product[]; };
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

vec3 refract_to_eye(vec3 n, vec3 w, float c) {
    vec3 tangent = w - c * n;
    if (c < 0.0) {
        float size = length(tangent);
        if (!(size > 0.0)) {
            return n;
        }
        tangent /= size;
        c = 0.0;
    }
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (under_root > 0.0) {
        return (tangent + sqrt(under_root) * n) / eta;
    }
    float size = length(tangent);
    return size > 0.0 ? tangent / size : n;
}

// The spherical harmonics of formats/opal/spherical_harmonics.cpp, of one degree a function.
vec3 add_degree_1(uint at, vec3 w) {
    return 0.4886025119 * (w.y * product[at].rgb + w.z * product[at + 1u].rgb +
                           w.x * product[at + 2u].rgb);
}

#if HARMONICS >= 9
vec3 add_degree_2(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z;
    return 1.0925484306 * x * y * product[at].rgb +
           1.0925484306 * y * z * product[at + 1u].rgb +
           0.3153915653 * (3.0 * z * z - 1.0) * product[at + 2u].rgb +
           1.0925484306 * x * z * product[at + 3u].rgb +
           0.5462742153 * (x * x - y * y) * product[at + 4u].rgb;
}
#endif

#if HARMONICS >= 16
vec3 add_degree_3(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z;
    return 0.5900435899 * y * (3.0 * x * x - y * y) * product[at].rgb +
           2.8906114426 * x * y * z * product[at + 1u].rgb +
           0.4570457995 * y * (5.0 * z * z - 1.0) * product[at + 2u].rgb +
           0.3731763326 * z * (5.0 * z * z - 3.0) * product[at + 3u].rgb +
           0.4570457995 * x * (5.0 * z * z - 1.0) * product[at + 4u].rgb +
           1.4453057213 * z * (x * x - y * y) * product[at + 5u].rgb +
           0.5900435899 * x * (x * x - 3.0 * y * y) * product[at + 6u].rgb;
}
#endif

#if HARMONICS >= 25
vec3 add_degree_4(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z, xx = x * x, yy = y * y, zz = z * z;
    return 2.5033429418 * x * y * (xx - yy) * product[at].rgb +
           1.7701307698 * y * z * (3.0 * xx - yy) * product[at + 1u].rgb +
           0.9461746958 * x * y * (7.0 * zz - 1.0) * product[at + 2u].rgb +
           0.6690465436 * y * z * (7.0 * zz - 3.0) * product[at + 3u].rgb +
           0.1057855469 * (zz * (35.0 * zz - 30.0) + 3.0) * product[at + 4u].rgb +
           0.6690465436 * x * z * (7.0 * zz - 3.0) * product[at + 5u].rgb +
           0.4730873479 * (xx - yy) * (7.0 * zz - 1.0) * product[at + 6u].rgb +
           1.7701307698 * x * z * (xx - 3.0 * yy) * product[at + 7u].rgb +
           0.6258357354 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy)) * product[at + 8u].rgb;
}
#endif

vec3 sum_harmonics(uint at, vec3 w) {
    vec3 sum = 0.2820947918 * product[at].rgb + add_degree_1(at + 1u, w);
#if HARMONICS >= 9
    sum += add_degree_2(at + 4u, w);
#endif
#if HARMONICS >= 16
    sum += add_degree_3(at + 9u, w);
#endif
#if HARMONICS >= 25
    sum += add_degree_4(at + 16u, w);
#endif
    return sum;
}

vec3 sum_toward_eye(uint vertex, uint at) {
    vec3 n = normal_of(vertex), to_eye = from_vertex_to_eye(vertex);
    float distance_to_eye = length(to_eye);
    vec3 w = distance_to_eye > 0.0 ? to_eye / distance_to_eye : n;
    float c = dot(n, w);
    if (c < 0.0 && is_double_sided != 0u) {
        n = -n;
        c = -c;
    }
    return sum_harmonics(at, refract_to_eye(n, w, c));
}
#else
vec3 sum_toward_eye(uint vertex, uint at) {
    return product[at].rgb;
}
#endif

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= vertices) {
        return;
    }
    vec3 sum = vec3(0.0);
#ifdef SHEET
    bool is_behind = dot(normal_of(vertex), from_vertex_to_eye(vertex)) < 0.0;
    sum = product[product_origin + 2u * vertex + (is_behind ? 1u : 0u)].rgb;
#elif defined(SEPARATE)
    uint at = product_origin + vertex * (uint(HARMONICS) + 1u);
    if (shows.x != 0u) {
        sum = product[at].rgb;
    }
    if (shows.y != 0u) {
        sum += sum_toward_eye(vertex, at + 1u);
    }
#else
    // Rows that hold both need both.
    if (shows.x != 0u && shows.y != 0u) {
        sum = sum_toward_eye(vertex, product_origin + vertex * uint(HARMONICS));
    }
#endif
    radiance[radiance_origin + vertex] = vec4(sum, 0.0);
}
