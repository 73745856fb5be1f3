// Light of emitters: rows beside those of the environment.
#include "runtime/emitter_light.h"

#include <gmock/gmock.h>

#include "runtime/texture.h"
#include "tests/formats/opal/emitter_fixture.h"
#include "tests/runtime/shade_test_support.h"

namespace opaline::runtime {
namespace {

using formats::Asset;
using formats::Rgb;

// Opaque, thin-walled and translucent primitives.
Asset emitting_asset() {
    Asset asset = tests::make_small_asset();
    tests::add_sheet_triangle(asset);
    tests::add_translucent_triangle(asset, 4, 1.3f);
    tests::add_emitters(asset);
    return asset;
}

LightVector black_light() {
    return {8, std::vector<float>(4 * 384)};
}

std::vector<Rgb> shaded(const Asset& asset, const LightVector& light, const EmitterLight& emitters,
                        std::optional<formats::Vec3> eye = std::nullopt) {
    ShadeOptions options;
    options.emitters = emitters;
    options.eye = eye;
    return tests::shaded(asset, light, options);
}

TEST(EmitterLight, OpaqueSurfacesShowItTimesTheirBaseColourAndTheirOwn) {
    const Asset asset = emitting_asset();
    const formats::AssetView view = asset.view();
    const std::vector<Rgb> out = shaded(asset, black_light(), {});
    for (std::uint32_t v = 0; v < 4; ++v) {
        const Rgb value = block_value(view.emitters, view.emitters.block[0], v);
        const Rgb own =
            Rgb{100, 50, 25} * sample_image_linear(view.images[0], asset.texcoord[v],
                                                   formats::Wrap::mirror, formats::Wrap::clamp);
        EXPECT_NEAR(out[v].r, 0.5f * value.r + own.r, 1e-3f);
        EXPECT_NEAR(out[v].g, 0.6f * value.g + own.g, 1e-3f);
    }
    const std::vector<Rgb> without = shaded(asset, black_light(), {{}, false});
    const Rgb value = block_value(view.emitters, view.emitters.block[0], 3);
    EXPECT_NEAR(without[3].b, 0.7f * value.b, 1e-4f);
}

TEST(EmitterLight, ThinWallsShowTheSideThatIsSeen) {
    const Asset asset = emitting_asset();
    const formats::AssetView view = asset.view();
    const auto blocks = view.emitters.blocks_of(2);
    ASSERT_EQ(blocks.size(), 1u);
    const auto front = shaded(asset, black_light(), {}, formats::Vec3{0, 0, 5});
    const auto behind = shaded(asset, black_light(), {}, formats::Vec3{0, 0, -5});
    EXPECT_NEAR(front[9].g, block_value(view.emitters, blocks[0], 2).g, 1e-3f);
    EXPECT_NEAR(behind[9].g, block_value(view.emitters, blocks[0], 3).g, 1e-3f);
}

// What a renderer interpolates has no light of the surface itself.
TEST(EmitterLight, PicturesAddTheirOwnLightPerPixel) {
    const Asset asset = emitting_asset();
    const auto with =
        shade_for_picture(asset.view(), black_light(), {0, 0, 5}, formats::TermSet::all, 1);
    const Rgb value = block_value(asset.emitters.view(), asset.emitters.block[0], 1);
    EXPECT_NEAR(with[1].r, value.r, 1e-3f);
}

}  // namespace
}  // namespace opaline::runtime
