#include "runtime/picture/tone_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace opaline::runtime {
namespace {

using formats::Rgb;

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
