// What a translucent vertex shows the eye without its Fresnel factor: sum_k h_k(w_o') <T_k, L>.
// The same steps as view_terms.cpp.
layout(local_size_x = 64) in;

layout(std430, binding = 0) readonly buffer Products { vec4 product[]; };
layout(std430, binding = 1) readonly buffer Positions { float position[]; };
layout(std430, binding = 2) readonly buffer Normals { float normal[]; };
layout(std430, binding = 3) writeonly buffer Irradiance { vec4 irradiance[]; };

layout(location = 0) uniform vec3 eye;
layout(location = 1) uniform float unit;  // 1 / distance scale: keeps squares within floats
layout(location = 2) uniform float eta;
layout(location = 3) uniform uint is_double_sided;
layout(location = 4) uniform uint terms;
layout(location = 5) uniform uint vertices;
// Where the batch's data begin in the bound ranges.
layout(location = 6) uniform uint product_origin;
layout(location = 7) uniform uint point_origin;  // of positions and normals
layout(location = 8) uniform uint irradiance_origin;
// Multiple scattering in a row of its own, before those of single scattering; which to add up.
layout(location = 9) uniform uint is_separate;
layout(location = 10) uniform uvec2 shows;  // multiple, single

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

vec3 add_degree_2(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z;
    return 1.0925484306 * x * y * product[at].rgb +
           1.0925484306 * y * z * product[at + 1u].rgb +
           0.3153915653 * (3.0 * z * z - 1.0) * product[at + 2u].rgb +
           1.0925484306 * x * z * product[at + 3u].rgb +
           0.5462742153 * (x * x - y * y) * product[at + 4u].rgb;
}

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

vec3 sum_harmonics(uint at, uint count, vec3 w) {
    vec3 sum = 0.2820947918 * product[at].rgb + add_degree_1(at + 1u, w);
    if (count >= 9u) {
        sum += add_degree_2(at + 4u, w);
    }
    if (count >= 16u) {
        sum += add_degree_3(at + 9u, w);
    }
    if (count >= 25u) {
        sum += add_degree_4(at + 16u, w);
    }
    return sum;
}

void main() {
    uint vertex = gl_GlobalInvocationID.x;
    if (vertex >= vertices) {
        return;
    }
    uint at = product_origin + vertex * terms;
    vec3 sum = vec3(0.0);
    uint count = terms;
    if (is_separate != 0u) {
        if (shows.x != 0u) {
            sum = product[at].rgb;
        }
        at += 1u;
        count -= 1u;
    }
    // Rows that hold both need both.
    bool shows_rest = shows.y != 0u && (is_separate != 0u || shows.x != 0u);
    if (count == 1u && shows_rest) {
        sum += product[at].rgb;
    } else if (count > 1u && shows_rest) {
        uint p = point_origin + 3u * vertex;
        vec3 n = vec3(normal[p], normal[p + 1u], normal[p + 2u]);
        vec3 to_eye = (eye - vec3(position[p], position[p + 1u], position[p + 2u])) * unit;
        float distance_to_eye = length(to_eye);
        vec3 w = distance_to_eye > 0.0 ? to_eye / distance_to_eye : n;
        float c = dot(n, w);
        if (c < 0.0 && is_double_sided != 0u) {
            n = -n;
            c = -c;
        }
        sum += sum_harmonics(at, count, refract_to_eye(n, w, c));
    }
    irradiance[irradiance_origin + vertex] = vec4(sum, 0.0);
}
