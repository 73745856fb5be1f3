#include "runtime/texture.h"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <limits>

namespace opaline::runtime {
namespace {

using formats::Float2;
using formats::PreviewImage;
using formats::Rgb;
using formats::Wrap;

// red green / blue white
constexpr std::array<std::uint8_t, 12> kPixels{255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255};
const PreviewImage kImage{2, 2, kPixels};

TEST(Texture, SrgbIsDecodedAsTheStandardSays) {
    EXPECT_EQ(linear_from_srgb(0), 0.0f);
    EXPECT_EQ(linear_from_srgb(255), 1.0f);
    EXPECT_NEAR(linear_from_srgb(10), 10.0 / 255 / 12.92, 1e-8);  // the straight part
    EXPECT_NEAR(linear_from_srgb(188), 0.5029, 1e-4);             // half the light
}

TEST(Texture, TexelCentresGiveTheTexelsRowZeroOnTop) {
    const auto at = [](float u, float v) {
        return sample_image_linear(kImage, {u, v}, Wrap::repeat, Wrap::repeat);
    };
    EXPECT_EQ(at(0.25f, 0.25f), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(0.75f, 0.25f), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(0.25f, 0.75f), (Rgb{0, 0, 1}));
    EXPECT_EQ(at(0.75f, 0.75f), (Rgb{1, 1, 1}));
    EXPECT_EQ(at(0.5f, 0.25f), (Rgb{0.5f, 0.5f, 0}));  // between, in linear light
}

TEST(Texture, WrapModesFollowTheirDefinition) {
    const auto at = [](float u, Wrap wrap) {
        return sample_image_linear(kImage, {u, 0.25f}, wrap, Wrap::clamp);
    };
    EXPECT_EQ(at(1.25f, Wrap::repeat), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(-0.25f, Wrap::repeat), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(1.0f, Wrap::repeat), (Rgb{0.5f, 0.5f, 0}));
    EXPECT_EQ(at(7.0f, Wrap::clamp), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(-7.0f, Wrap::clamp), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(1.25f, Wrap::mirror), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(1.75f, Wrap::mirror), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(-0.25f, Wrap::mirror), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(2.0f, Wrap::mirror), (Rgb{1, 0, 0}));
}

TEST(Texture, NearestWrapModesGiveTheTexelThatTheCoordinateIsIn) {
    const auto at = [](float u, Wrap wrap) {
        return sample_image_linear(kImage, {u, 0.26f}, wrap, Wrap::nearest_clamp);
    };
    for (const Wrap wrap : {Wrap::nearest_repeat, Wrap::nearest_clamp, Wrap::nearest_mirror}) {
        EXPECT_EQ(at(0.01f, wrap), (Rgb{1, 0, 0}));
        EXPECT_EQ(at(0.49f, wrap), (Rgb{1, 0, 0}));
        EXPECT_EQ(at(0.51f, wrap), (Rgb{0, 1, 0}));
        EXPECT_EQ(at(0.99f, wrap), (Rgb{0, 1, 0}));
    }
    EXPECT_EQ(at(1.4f, Wrap::nearest_repeat), (Rgb{1, 0, 0}));
    EXPECT_EQ(at(1.4f, Wrap::nearest_clamp), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(1.4f, Wrap::nearest_mirror), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(-0.1f, Wrap::nearest_repeat), (Rgb{0, 1, 0}));
    EXPECT_EQ(at(-0.1f, Wrap::nearest_clamp), (Rgb{1, 0, 0}));
}

TEST(Texture, AbsurdCoordinatesGiveAColourOfTheImage) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity();
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp, Wrap::mirror, Wrap::nearest_repeat,
                            Wrap::nearest_clamp, Wrap::nearest_mirror}) {
        for (const float u : {1e30f, -1e30f, 3.4e38f, kInfinite, -kInfinite, NAN, -1e-40f}) {
            const Rgb c = sample_image_linear(kImage, {u, u}, wrap, wrap);
            EXPECT_TRUE(c.r >= 0 && c.r <= 1 && c.g >= 0 && c.g <= 1 && c.b >= 0 && c.b <= 1) << u;
        }
    }
}

}  // namespace
}  // namespace opaline::runtime
