#include "bake/scene/texture_pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace opaline::tests {
namespace {

using bake::ImageLookup;
using bake::TexturePyramid;
using formats::TextureWrap;

/// Red rises along u, green along v; linear codes.
formats::Image8 ramps(std::uint32_t width, std::uint32_t height) {
    formats::Image8 image{width, height, {}};
    for (std::uint32_t y = 0; y < height; ++y) {
        for (std::uint32_t x = 0; x < width; ++x) {
            image.rgba.insert(
                image.rgba.end(),
                {static_cast<std::uint8_t>(255 * x / std::max(1u, width - 1)),
                 static_cast<std::uint8_t>(255 * y / std::max(1u, height - 1)), 0, 255});
        }
    }
    return image;
}

/// Of a footprint along the axes of the texture.
bake::UvMoments moments(float u, float v) {
    return {u * u, 0, v * v};
}

glm::vec4 mean_of(const formats::Image8& image) {
    glm::dvec4 sum(0);
    for (std::size_t i = 0; i < image.rgba.size(); i += 4) {
        sum += glm::dvec4(image.rgba[i], image.rgba[i + 1], image.rgba[i + 2], image.rgba[i + 3]);
    }
    return glm::vec4(sum / (255.0 * static_cast<double>(image.rgba.size() / 4)));
}

TEST(TexturePyramid, EveryLevelHasTheMeanOfTheImage) {
    for (const auto& [width, height] : {std::pair{16u, 16u}, {13u, 7u}, {1u, 9u}, {5u, 1u}}) {
        const formats::Image8 image = ramps(width, height);
        const TexturePyramid pyramid = bake::make_pyramid(image, true);
        ASSERT_FALSE(pyramid.coarser.empty());
        EXPECT_EQ(pyramid.coarser.back().texel.size(), 1u);
        for (const TexturePyramid::Level& level : pyramid.coarser) {
            glm::vec4 sum(0);
            for (const glm::vec4& texel : level.texel) {
                sum += texel;
            }
            const glm::vec4 off = sum / static_cast<float>(level.texel.size()) - mean_of(image);
            EXPECT_LT(glm::length(off), 1e-5f) << width << " x " << height;
        }
    }
}

TEST(TexturePyramid, AFootprintBelowATexelIsThePoint) {
    const formats::Image8 image = ramps(8, 8);
    const TexturePyramid pyramid = bake::make_pyramid(image, true);
    const ImageLookup lookup{image, TextureWrap::clamp, TextureWrap::mirror, true};
    for (const glm::vec2 uv : {glm::vec2(0.3f, 0.6f), {-0.2f, 1.7f}}) {
        for (const float size : {0.0f, 0.05f}) {
            EXPECT_EQ(bake::sample_footprint(lookup, pyramid, uv, moments(size, size)),
                      bake::sample_image(lookup, uv));
        }
    }
}

TEST(TexturePyramid, NearestSamplersGiveTexelsWhereTheImageIsMagnified) {
    formats::Image8 image{2, 1, {255, 255, 255, 255, 0, 0, 0, 255}};
    const TexturePyramid pyramid = bake::make_pyramid(image, true);
    const auto red = [&](TextureWrap mode, float u) {
        const ImageLookup lookup{image, mode, TextureWrap::nearest_clamp, true};
        const float point = bake::sample_image(lookup, {u, 0.5f}).r;
        EXPECT_EQ(bake::sample_footprint(lookup, pyramid, {u, 0.5f}, moments(0.01f, 0.01f)).r,
                  point);
        return point;
    };
    EXPECT_EQ(red(TextureWrap::nearest_repeat, 0.49f), 1);
    EXPECT_EQ(red(TextureWrap::nearest_repeat, 0.51f), 0);
    EXPECT_EQ(red(TextureWrap::nearest_repeat, 1.01f), 1);
    EXPECT_EQ(red(TextureWrap::nearest_clamp, 1.01f), 0);
    EXPECT_EQ(red(TextureWrap::nearest_mirror, 1.01f), 0);
    EXPECT_EQ(red(TextureWrap::nearest_mirror, -0.1f), 1);
}

// Look-ups in a level whose texels are all like the image's see the same wrapped plane.
TEST(TexturePyramid, CoarserLevelsWrapAsTheImageDoes) {
    formats::Image8 image{4, 4, {}};
    for (std::uint32_t i = 0; i < 16; ++i) {
        const auto value = static_cast<std::uint8_t>(i % 4 < 2 ? 255 : 0);
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    const TexturePyramid pyramid = bake::make_pyramid(image, true);
    const bake::UvMoments two_texels = moments(0.5f, 0.5f);
    const auto red = [&](TextureWrap mode, float u) {
        return bake::sample_footprint({image, mode, mode, true}, pyramid, {u, 0.5f}, two_texels).r;
    };
    // Level 1 has a texel of 1 around u = 1/4 and one of 0 around 3/4.
    EXPECT_NEAR(red(TextureWrap::repeat, 0.25f), 1, 1e-5);
    EXPECT_NEAR(red(TextureWrap::repeat, 1.25f), 1, 1e-5);
    EXPECT_NEAR(red(TextureWrap::repeat, 0.0f), 0.5, 1e-5);
    EXPECT_NEAR(red(TextureWrap::repeat, -0.25f), 0, 1e-5);
    EXPECT_NEAR(red(TextureWrap::mirror, -0.25f), 1, 1e-5);
    EXPECT_NEAR(red(TextureWrap::mirror, 1.25f), 0, 1e-5);
    EXPECT_NEAR(red(TextureWrap::clamp, -3), 1, 1e-5);
    EXPECT_NEAR(red(TextureWrap::clamp, 7), 0, 1e-5);
    EXPECT_NEAR(red(TextureWrap::nearest_clamp, 7), 0, 1e-5);
    EXPECT_NEAR(red(TextureWrap::nearest_mirror, 1.25f), 0, 1e-5);
    EXPECT_TRUE(std::isfinite(red(TextureWrap::repeat, std::numeric_limits<float>::quiet_NaN())));
}

// Stripes along the diagonal: a footprint along them sees one, one across them the mean.
TEST(TexturePyramid, ASlantedFootprintFiltersAlongItself) {
    formats::Image8 image{64, 64, {}};
    for (std::uint32_t i = 0; i < 64 * 64; ++i) {
        const auto value = static_cast<std::uint8_t>((i % 64 + i / 64) % 32 < 16 ? 255 : 0);
        image.rgba.insert(image.rgba.end(), {value, value, value, 255});
    }
    const TexturePyramid pyramid = bake::make_pyramid(image, true);
    const ImageLookup lookup{image, TextureWrap::repeat, TextureWrap::repeat, true};
    const glm::vec2 uv(4.0f / 64, 4.0f / 64);  // x + y = 8: in the middle of a stripe
    const float square = (22.6f / 64) * (22.6f / 64) / 2;
    EXPECT_NEAR(bake::sample_footprint(lookup, pyramid, uv, {square, -square, square}).r, 1, 0.02);
    EXPECT_NEAR(bake::sample_footprint(lookup, pyramid, uv, {square, square, square}).r, 0.5, 0.05);
}

TEST(TexturePyramid, AScenesImagesAreReadAsTheirMaterialsReadThem) {
    formats::Scene scene;
    scene.images = {ramps(4, 4), ramps(2, 2), ramps(2, 2), {8, 8, {}}};
    scene.images[3].rgba.assign(4 * 64, 200);
    scene.materials.resize(3);
    scene.materials[0].base_color_image = 0;
    scene.materials[1].gloss.image = 0;
    scene.materials[1].emission_image = 2;
    scene.materials[2].base_color_image = 3;  // even: not filtered
    const bake::ScenePyramids pyramids = bake::make_scene_pyramids(scene);
    ASSERT_EQ(pyramids.color.size(), 4u);
    EXPECT_EQ(pyramids.color[0].coarser.size(), 2u);
    EXPECT_EQ(pyramids.data[0].coarser.size(), 2u);
    EXPECT_GT(pyramids.data[0].coarser.back().texel[0].r,
              pyramids.color[0].coarser.back().texel[0].r);  // sRGB codes are brighter than values
    EXPECT_TRUE(pyramids.color[1].coarser.empty());
    EXPECT_EQ(pyramids.color[2].coarser.size(), 1u);
    EXPECT_TRUE(pyramids.color[3].coarser.empty());
    EXPECT_TRUE(pyramids.any());
    EXPECT_TRUE(bake::has_pyramid(pyramids, scene.materials[1]));
    EXPECT_FALSE(bake::has_pyramid(pyramids, scene.materials[2]));
}

}  // namespace
}  // namespace opaline::tests
