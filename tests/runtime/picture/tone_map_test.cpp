#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "runtime/picture/tone_map.h"

namespace opaline::runtime {
namespace {

using formats::Rgb;

TEST(ToneMap, GreyIsMonotoneAndInRangeFromBlackToTheLargestFloat) {
    float previous = -1;
    for (double x = 1e-6; x < 1e38; x *= 1.05) {
        const auto grey = static_cast<float>(x);
        const Rgb c = tone_map_neutral({grey, grey, grey});
        EXPECT_GE(c.g, previous) << x;
        EXPECT_GE(c.g, 0.0f);
        EXPECT_LE(c.g, 1.0f);
        previous = c.g;
    }
    EXPECT_NEAR(previous, 1.0f, 1e-6f);
}

TEST(ToneMap, BaseColoursLoseTheFresnelOffsetOnly) {
    // With every band above 0.08, the specification subtracts 0.04 and leaves the rest up to 0.76.
    const Rgb c = tone_map_neutral({0.5f, 0.3f, 0.1f});
    EXPECT_NEAR(c.r, 0.46f, 1e-6f);
    EXPECT_NEAR(c.g, 0.26f, 1e-6f);
    EXPECT_NEAR(c.b, 0.06f, 1e-6f);
}

TEST(ToneMap, IsContinuousAtItsTwoBreaks) {
    for (const float x : {0.08f, 0.8f}) {
        const Rgb below = tone_map_neutral({x * 0.9999f, x * 0.9999f, x * 0.9999f});
        const Rgb above = tone_map_neutral({x * 1.0001f, x * 1.0001f, x * 1.0001f});
        EXPECT_NEAR(below.r, above.r, 4e-4f * x);
    }
}

// Flames were salmon, their blue nearly as bright as their green.
TEST(ToneMap, BrightFireGoesFromOrangeOverYellowToWhite) {
    const Rgb fire{1.0f, 0.3f, 0.02f};  // some 1900 K
    float green = 0;
    for (const float gain : {1.5f, 3.0f, 6.0f}) {
        const Rgb c = tone_map_neutral(gain * fire);
        EXPECT_GT(c.g, green) << gain;
        EXPECT_LT(c.b, 0.55f * c.g) << gain;
        green = c.g;
    }
    EXPECT_GT(green, 0.9f);
    EXPECT_GT(tone_map_neutral(300 * fire).b, 0.9f);
}

TEST(ToneMap, AnyInputGivesAColour) {
    const float inf = std::numeric_limits<float>::infinity();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float r : {-inf, -1.0f, 0.0f, inf, nan, 3.4e38f}) {
        for (const float g : {-1.0f, 0.5f, inf, nan}) {
            const Rgb c = tone_map_neutral({r, g, 0.2f});
            for (const float value : {c.r, c.g, c.b}) {
                EXPECT_GE(value, 0.0f);
                EXPECT_LE(value, 1.0f);
            }
        }
    }
}

TEST(EncodeSrgb, HitsThePublishedEndsAndMiddle) {
    EXPECT_EQ(encode_srgb(0.0f), 0.0f);
    EXPECT_NEAR(encode_srgb(1.0f), 1.0f, 1e-6f);
    EXPECT_NEAR(encode_srgb(0.0031308f), 0.04045f, 1e-5f);
    EXPECT_NEAR(encode_srgb(0.2140411f), 0.5f, 1e-5f);  // ((0.5 + 0.055) / 1.055)^2.4
}

TEST(ToneMap, ExposureDoublesPerStopAndThePictureKeepsItsLayout) {
    Picture picture{2, 1, {{0.1f, 0.2f, 0.3f}, {0.0f, 0.0f, 0.0f}}};
    Picture doubled{2, 1, {{0.2f, 0.4f, 0.6f}, {0.0f, 0.0f, 0.0f}}};
    const DisplayPicture a = tone_map(picture, 1.0f), b = tone_map(doubled, 0.0f);
    EXPECT_EQ(a.rgba, b.rgba);
    ASSERT_EQ(a.rgba.size(), 8u);
    EXPECT_EQ(a.rgba[3], 255);
    EXPECT_EQ(a.rgba[4], 0);
    EXPECT_LT(a.rgba[0], a.rgba[2]);
}

TEST(ToneMap, NoneKeepsRadianceBelowOneAndCutsTheRest) {
    const Picture picture{2, 1, {{0.25f, 1.0f, 7.0f}, {-1.0f, 0.5f, 0.0f}}};
    const DisplayPicture display = tone_map(picture, 0.0f, ToneMap::none);
    const auto byte = [](float linear) {
        return static_cast<std::uint8_t>(std::lround(255 * encode_srgb(linear)));
    };
    EXPECT_EQ(display.rgba,
              (std::vector<std::uint8_t>{byte(0.25f), 255, 255, 255, 0, byte(0.5f), 0, 255}));
}

// Of a picture whose pixels have the radiance `object`, some in shadow, before black.
float exposure_of(float object) {
    Picture picture{4, 4, std::vector<Rgb>(16)};
    for (std::size_t i = 0; i < 10; ++i) {
        const float shadow = i < 6 ? 1.0f : 0.01f;
        picture.pixel[i] = shadow * object * Rgb{1, 1, 1};
    }
    return choose_exposure(picture);
}

TEST(AutoExposure, UsualBrightnessIsShownAsItIs) {
    for (const float object : {0.02f, 0.18f, 0.5f, 1.0f, 1.45f}) {
        EXPECT_EQ(exposure_of(object), 0.0f) << object;
    }
}

// A sun of 2 W/m2, which exporters write as 1366 lux, made a white picture.
TEST(AutoExposure, ASunInLuxIsShownAsBrightAsAStudio) {
    const float sunlit = 1366 / 3.14159f * 0.8f;
    EXPECT_NEAR(sunlit * std::exp2(exposure_of(sunlit)), 0.35f, 0.01f);
}

TEST(AutoExposure, TheDarkStaysDimAndBlackIsNotRaised) {
    EXPECT_NEAR(0.002f * std::exp2(exposure_of(0.002f)), 1.0f / 64, 2e-4f);
    EXPECT_EQ(exposure_of(1e-12f), 10.0f);
    EXPECT_EQ(exposure_of(0), 0.0f);
    EXPECT_EQ(choose_exposure({}), 0.0f);
}

TEST(AutoExposure, ChangesWithoutStepsAndDarkensTheBrighterMore) {
    float last = exposure_of(0.001f);
    for (float object = 0.001f; object < 1e5f; object *= 1.02f) {
        const float exposure = exposure_of(object);
        EXPECT_LE(exposure, last);
        EXPECT_GE(exposure, last - 0.1f);
        last = exposure;
    }
}

TEST(AutoExposure, DamagedPixelsAreLeftOut) {
    const float inf = std::numeric_limits<float>::infinity();
    const Picture picture{4, 1, {{inf, 0, 0}, {NAN, 1, 1}, {-1, -1, -1}, {0.5f, 0.5f, 0.5f}}};
    EXPECT_EQ(choose_exposure(picture), 0.0f);
}

TEST(MeterCamera, SeesTheSameInFewPixels) {
    Camera camera;
    camera.eye = {1, 2, 3};
    camera.width = 1280;
    camera.height = 640;
    const Camera small = meter_camera(camera);
    EXPECT_EQ(small.width, 96u);
    EXPECT_EQ(small.height, 48u);
    EXPECT_EQ(small.eye, camera.eye);
    camera.width = 40;
    camera.height = 1;
    EXPECT_EQ(meter_camera(camera).width, 40u);
}

}  // namespace

}  // namespace opaline::runtime
