const float kPi = 3.14159265358979;

// The built-in arc tangent may be off by 1e-4 rad, a texel of a large map. This one: reduction to
// |t| <= tan(pi / 8), then the Taylor series; its first left-out term is below 2e-8.
float arc_tangent(float y, float x) {
    float a = abs(y), b = abs(x);
    float t = max(a, b) > 0.0 ? min(a, b) / max(a, b) : 0.0;
    bool far = t > 0.41421356;
    t = far ? (t - 1.0) / (t + 1.0) : t;
    float s = t * t;
    float series = t * (1.0 - s * (1.0 / 3.0 - s * (1.0 / 5.0 - s * (1.0 / 7.0 - s *
                   (1.0 / 9.0 - s * (1.0 / 11.0 - s * (1.0 / 13.0 - s / 15.0)))))));
    float angle = far ? 0.25 * kPi + series : series;
    angle = a > b ? 0.5 * kPi - angle : angle;
    angle = x < 0.0 ? kPi - angle : angle;
    return y < 0.0 ? -angle : angle;
}
