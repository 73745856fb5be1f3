#pragma once

namespace opaline::formats {

/// Three independent bands: linear Rec. 709 red, green, blue.
struct Rgb {
    float r = 0, g = 0, b = 0;

    friend bool operator==(const Rgb&, const Rgb&) = default;
    friend Rgb operator+(Rgb x, Rgb y) { return {x.r + y.r, x.g + y.g, x.b + y.b}; }
    friend Rgb operator*(Rgb x, Rgb y) { return {x.r * y.r, x.g * y.g, x.b * y.b}; }
    friend Rgb operator*(float s, Rgb x) { return {s * x.r, s * x.g, s * x.b}; }
};

/// Luminance of linear Rec. 709.
inline float luminance(Rgb c) {
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

}  // namespace opaline::formats
