// Which samples of a picture see a surface that light passes in places.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "runtime/surface.h"
#include "runtime/texture.h"

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

using formats::HoleMode;
using formats::HoleRecord;

TEST(Holes, AMaskIsThereWhereAlphaReachesItsCutoff) {
    const HoleRecord mask{.cutoff = 0.5f};
    EXPECT_TRUE(sees_surface(mask, 0.5f, {3, 4, 5}));
    EXPECT_FALSE(sees_surface(mask, 0.4999f, {3, 4, 5}));
    EXPECT_FALSE(sees_surface({.cutoff = 1.5f}, 1, {}));
}

TEST(Holes, AlphaOfABlendIsTheShareOfTheSamplesOfAnySquare) {
    const HoleRecord blend{.mode = HoleMode::blend};
    for (const float alpha : {0.0f, 0.1f, 0.5f, 0.77f, 1.0f}) {
        for (const std::uint32_t size : {6u, 12u, 48u}) {
            for (const std::uint32_t first : {0u, 1000u, 100001u}) {
                int seen = 0;
                for (std::uint32_t i = 0; i < size * size; ++i) {
                    seen += sees_surface(blend, alpha, {first + i % size, i / size, 7}) ? 1 : 0;
                }
                // Far less than the 0.5 / size of samples drawn at random.
                EXPECT_NEAR(seen / double(size * size), alpha, 1.3 / (size * std::sqrt(size)))
                    << alpha << " " << size;
            }
        }
    }
}

TEST(Holes, OfTwoSurfacesBehindEachOtherAreIndependentOnAverage) {
    const HoleRecord blend{.mode = HoleMode::blend};
    int both = 0;
    for (std::uint32_t vertex = 0; vertex < 64; ++vertex) {
        for (std::uint32_t i = 0; i < 900; ++i) {
            const std::uint32_t column = i % 30, row = i / 30;
            both += sees_surface(blend, 0.5f, {column, row, 1000}) &&
                            sees_surface(blend, 0.5f, {column, row, vertex})
                        ? 1
                        : 0;
        }
    }
    EXPECT_NEAR(both / (64 * 900.0), 0.25, 0.01);
}

TEST(Holes, AlphaIsTheProductOfRecordVertexAndImage) {
    formats::AssetView asset;
    const std::uint8_t pixels[]{51, 0, 0, 255, 0, 0};
    asset.images.push_back({2, 1, pixels});
    HoleRecord hole{.alpha = 0.5f};
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0, 0}, 0.5f), 0.25f);
    hole.image = 0;
    hole.wrap_u = formats::Wrap::clamp;
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0, 0.5f}, 0.5f), 0.05f);
    EXPECT_FLOAT_EQ(alpha_at(asset, hole, {0.5f, 0.5f}, 1), 0.3f);
}

}  // namespace

}  // namespace opaline::runtime
