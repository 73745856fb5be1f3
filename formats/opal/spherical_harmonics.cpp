#include "formats/opal/spherical_harmonics.h"

namespace opaline::formats {
namespace {

// Polynomials on the unit sphere: neither poles nor recurrences, so exact to some roundings.
// The numbers are the normalisations of README.md's table.

void eval_degree_2(Vec3 w, float* value) {
    const auto [x, y, z] = w;
    value[0] = 1.0925484306f * x * y;
    value[1] = 1.0925484306f * y * z;
    value[2] = 0.3153915653f * (3 * z * z - 1);
    value[3] = 1.0925484306f * x * z;
    value[4] = 0.5462742153f * (x * x - y * y);
}

void eval_degree_3(Vec3 w, float* value) {
    const auto [x, y, z] = w;
    value[0] = 0.5900435899f * y * (3 * x * x - y * y);
    value[1] = 2.8906114426f * x * y * z;
    value[2] = 0.4570457995f * y * (5 * z * z - 1);
    value[3] = 0.3731763326f * z * (5 * z * z - 3);
    value[4] = 0.4570457995f * x * (5 * z * z - 1);
    value[5] = 1.4453057213f * z * (x * x - y * y);
    value[6] = 0.5900435899f * x * (x * x - 3 * y * y);
}

void eval_degree_4(Vec3 w, float* value) {
    const auto [x, y, z] = w;
    const float xx = x * x, yy = y * y, zz = z * z;
    value[0] = 2.5033429418f * x * y * (xx - yy);
    value[1] = 1.7701307698f * y * z * (3 * xx - yy);
    value[2] = 0.9461746958f * x * y * (7 * zz - 1);
    value[3] = 0.6690465436f * y * z * (7 * zz - 3);
    value[4] = 0.1057855469f * (zz * (35 * zz - 30) + 3);
    value[5] = 0.6690465436f * x * z * (7 * zz - 3);
    value[6] = 0.4730873479f * (xx - yy) * (7 * zz - 1);
    value[7] = 1.7701307698f * x * z * (xx - 3 * yy);
    value[8] = 0.6258357354f * (xx * (xx - 3 * yy) - yy * (3 * xx - yy));
}

}  // namespace

void eval_spherical_harmonics(Vec3 w, std::span<float> value) {
    value[0] = 0.2820947918f;
    if (value.size() >= 4) {
        value[1] = 0.4886025119f * w.y;
        value[2] = 0.4886025119f * w.z;
        value[3] = 0.4886025119f * w.x;
    }
    if (value.size() >= 9) {
        eval_degree_2(w, &value[4]);
    }
    if (value.size() >= 16) {
        eval_degree_3(w, &value[9]);
    }
    if (value.size() >= 25) {
        eval_degree_4(w, &value[16]);
    }
}

}  // namespace opaline::formats
