// Spherical harmonics of a direction, formats/opal/spherical_harmonics.cpp; the first HARMONICS.
void find_harmonics(vec3 w, out float value[HARMONICS]) {
    float x = w.x, y = w.y, z = w.z, xx = x * x, yy = y * y, zz = z * z;
    value[0] = 0.2820947918;
#if HARMONICS >= 4
    value[1] = 0.4886025119 * y;
    value[2] = 0.4886025119 * z;
    value[3] = 0.4886025119 * x;
#endif
#if HARMONICS >= 9
    value[4] = 1.0925484306 * x * y;
    value[5] = 1.0925484306 * y * z;
    value[6] = 0.3153915653 * (3.0 * zz - 1.0);
    value[7] = 1.0925484306 * x * z;
    value[8] = 0.5462742153 * (xx - yy);
#endif
#if HARMONICS >= 16
    value[9] = 0.5900435899 * y * (3.0 * xx - yy);
    value[10] = 2.8906114426 * x * y * z;
    value[11] = 0.4570457995 * y * (5.0 * zz - 1.0);
    value[12] = 0.3731763326 * z * (5.0 * zz - 3.0);
    value[13] = 0.4570457995 * x * (5.0 * zz - 1.0);
    value[14] = 1.4453057213 * z * (xx - yy);
    value[15] = 0.5900435899 * x * (xx - 3.0 * yy);
#endif
#if HARMONICS >= 25
    value[16] = 2.5033429418 * x * y * (xx - yy);
    value[17] = 1.7701307698 * y * z * (3.0 * xx - yy);
    value[18] = 0.9461746958 * x * y * (7.0 * zz - 1.0);
    value[19] = 0.6690465436 * y * z * (7.0 * zz - 3.0);
    value[20] = 0.1057855469 * (zz * (35.0 * zz - 30.0) + 3.0);
    value[21] = 0.6690465436 * x * z * (7.0 * zz - 3.0);
    value[22] = 0.4730873479 * (xx - yy) * (7.0 * zz - 1.0);
    value[23] = 1.7701307698 * x * z * (xx - 3.0 * yy);
    value[24] = 0.6258357354 * (xx * (xx - 3.0 * yy) - yy * (3.0 * xx - yy));
#endif
}
