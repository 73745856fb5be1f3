// What rows of several terms show the eye: sum_k h_k(w_o') <T_k, L>, the same steps as
// view_terms.cpp. Specialised by HARMONICS, the rows that the direction to the eye weighs: 1, 4, 9,
// 16 or 25.
vec3 product_at(uint row);  // <T_k, L>

#if HARMONICS > 1
vec3 refract_to_eye(vec3 n, vec3 w, float c, float eta) {
    vec3 tangent = w - c * n;
    if (c < 0.0) {
        float size = length(tangent);
        if (!(size > 0.0)) return n;
        tangent /= size;
        c = 0.0;
    }
    float under_root = (eta - 1.0) * (eta + 1.0) + c * c;
    if (under_root > 0.0) return (tangent + sqrt(under_root) * n) / eta;
    float size = length(tangent);
    return size > 0.0 ? tangent / size : n;
}

// The spherical harmonics of formats/opal/spherical_harmonics.cpp, of one degree a function.
vec3 add_degree_1(uint at, vec3 w) {
    return 0.4886025119 * (w.y * product_at(at) + w.z * product_at(at + 1u) +
                           w.x * product_at(at + 2u));
}

#if HARMONICS >= 9
vec3 add_degree_2(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z;
    return 1.0925484306 * x * y * product_at(at) +
           1.0925484306 * y * z * product_at(at + 1u) +
           0.3153915653 * (3.0 * z * z - 1.0) * product_at(at + 2u) +
           1.0925484306 * x * z * product_at(at + 3u) +
           0.5462742153 * (x * x - y * y) * product_at(at + 4u);
}
#endif

#if HARMONICS >= 16
vec3 add_degree_3(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z;
    return 0.5900435899 * y * (3.0 * x * x - y * y) * product_at(at) +
           2.8906114426 * x * y * z * product_at(at + 1u) +
           0.4570457995 * y * (5.0 * z * z - 1.0) * product_at(at + 2u) +
           0.3731763326 * z * (5.0 * z * z - 3.0) * product_at(at + 3u) +
           0.4570457995 * x * (5.0 * z * z - 1.0) * product_at(at + 4u) +
           1.4453057213 * z * (x * x - y * y) * product_at(at + 5u) +
           0.5900435899 * x * (x * x - 3.0 * y * y) * product_at(at + 6u);
}
#endif

#if HARMONICS >= 25
vec3 add_degree_4(uint at, vec3 w) {
    float x = w.x, y = w.y, z = w.z, xx = x * x, yy = y * y, zz = z * z;
    return 2.5033429418 * x * y * (xx - yy) * product_at(at) +
           1.7701307698 * y * z * (3.0 * xx - yy) * product_at(at + 1u) +
           0.9461746958 * x * y * (7.0 * zz - 1.0) * product_at(at + 2u) +
           0.6690465436 * y * z * (7.0 * zz - 3.0) * product_at(at + 3u) +
           0.1057855469 * (zz * (35.0 * zz - 30.0) + 3.0) * product_at(at + 4u) +
           0.6690465436 * x * z * (7.0 * zz - 3.0) * product_at(at + 5u) +
           0.4730873479 * (xx - yy) * (7.0 * zz - 1.0) * product_at(at + 6u) +
           1.7701307698 * x * z * (xx - 3.0 * yy) * product_at(at + 7u) +
           0.6258357354 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy)) * product_at(at + 8u);
}
#endif

vec3 sum_harmonics(uint at, vec3 w) {
    vec3 sum = 0.2820947918 * product_at(at) + add_degree_1(at + 1u, w);
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

// `to_eye`: from the receiver, of any length; `at`: its first row.
vec3 sum_toward_eye(vec3 n, vec3 to_eye, float eta, bool is_double_sided, uint at) {
    float distance_to_eye = length(to_eye);
    vec3 w = distance_to_eye > 0.0 ? to_eye / distance_to_eye : n;
    float c = dot(n, w);
    if (c < 0.0 && is_double_sided) {
        n = -n;
        c = -c;
    }
    return sum_harmonics(at, refract_to_eye(n, w, c, eta));
}
#endif
