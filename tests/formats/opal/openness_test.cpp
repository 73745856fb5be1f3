#include "formats/opal/openness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opaline::formats {
namespace {

TEST(Openness, ComesBackWithinItsBits) {
    for (int i = 0; i < 2000; ++i) {
        const float t = static_cast<float>(i);
        const Vec3 axis = normalize({std::sin(t), std::cos(2.3f * t), std::sin(3.1f * t + 1)});
        const float fraction = 0.5f + 0.5f * std::sin(0.7f * t);
        const Openness openness = encode_openness(3.0f * axis, fraction);
        EXPECT_LT(length(open_axis(openness) - axis), 0.0175f);  // 1 degree
        EXPECT_NEAR(open_fraction(openness), fraction, 1.0f / 255);
    }
    for (const Vec3 axis : {Vec3{1, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, -1, 0},
                            Vec3{0, 0, 1}, Vec3{0, 0, -1}}) {
        EXPECT_EQ(open_axis(encode_openness(axis, 1)), axis);
    }
    // What is exactly open or closed stays so, and nothing else becomes so.
    EXPECT_EQ(open_fraction(encode_openness({0, 0, 1}, 1)), 1.0f);
    EXPECT_EQ(open_fraction(encode_openness({0, 0, 1}, 0)), 0.0f);
    EXPECT_LT(open_fraction(encode_openness({0, 0, 1}, 0.99999f)), 1.0f);
    EXPECT_GT(open_fraction(encode_openness({0, 0, 1}, 1e-6f)), 0.0f);
    // Absurd input gives something that can be decoded.
    const float nan = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(open_axis(encode_openness({0, 0, 0}, nan)), (Vec3{0, 0, 1}));
    EXPECT_EQ(encode_openness({nan, 1, 0}, nan).fraction, 0);
    for (int x = -128; x < 128; x += 5) {
        Openness any;
        any.axis[0] = any.axis[1] = static_cast<std::int8_t>(x);
        EXPECT_NEAR(length(open_axis(any)), 1, 1e-6f);
    }
}

}  // namespace
}  // namespace opaline::formats
